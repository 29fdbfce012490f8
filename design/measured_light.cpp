#include "design/measured_light.h"

#include <algorithm>
#include <utility>

#include "mesh/cleaning/joined_surfaces.h"
#include "mesh/patches/mesh_bounds.h"
#include "radiosity/solution/relight.h"
#include "viewer/export/start_view.h"
#include "viewer/report/measure.h"
#include "viewer/report/requested_grids.h"

namespace lightwell {

MeasuredLight::MeasuredLight(const ReportedScene& of, SolvedScene& solved, LightPlaces places)
    : scene_(of.scene),
      solved_(solved),
      places_(std::move(places)),
      caster_(solved.mesh),
      tables_(of.scene, caster_) {
  const Eigen::Vector3d up = guess_up_axis(scene_.cameras, mesh_bounds(solved.mesh));
  const Scene named = of.names ? of.names->apart(scene_) : scene_;
  // Grids leave out others by their places in the whole list.
  const std::vector<LuxGrid> all = requested_grids({}, places_.grids, named, caster_, up);
  for (const int grid : places_.limited) {
    grids_.push_back(without_buried_points(caster_, all[static_cast<std::size_t>(grid)]));
  }
}

void MeasuredLight::relight_at(const std::vector<double>& levels) {
  std::vector<Spectrum> scales;
  for (const double level : levels) {
    scales.push_back(constant_spectrum(scene_.bands, static_cast<float>(level)));
  }
  relight(solved_, scales);
}

PlanLines MeasuredLight::lines_of(const LuxGrid& grid) const {
  return plan_lines(scene_, caster_, grid, places_.eyes);
}

LightReadings MeasuredLight::measure(const std::vector<double>& levels, std::uint64_t replica,
                                     const std::function<void()>& between) {
  relight_at(levels);
  const DirectLight lights(scene_, solved_.mesh, {}, &tables_);
  GatherOptions gathering{.rays = places_.rays, .replica = replica};
  LightReadings readings;
  for (const LuxGrid& grid : grids_) {
    readings.fields.push_back(measure_grid(scene_, caster_, lights, solved_.solution, grid,
                                           places_.maintenance_factor, gathering));
    if (between) between();
  }
  gathering.rays = std::max(gathering.rays, rays_of_an_eye);
  for (const Camera& eye : places_.eyes) {
    readings.glares.push_back(unified_glare_rating(scene_, caster_, lights, solved_.solution, eye,
                                                   gathering, places_.luminous_heights));
    const std::vector<std::string>& left_out = readings.glares.back().left_out;
    left_out_.insert(left_out.begin(), left_out.end());
    if (between) between();
  }
  return readings;
}

}  // namespace lightwell
