#include "viewer/report/year_walk.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "daylight/year_basis.h"
#include "viewer/export/baked_year.h"
#include "viewer/export/export.h"

namespace lightwell {
namespace {

// Eyes of people over a floor, m, and lower ones in lower rooms.
constexpr double eye_height = 1.6;

// A view over the first room from its dimmest sensor to its brightest one.
Camera view_of_room(const DaylightStudy& study, const StudiedModel& of, const StudiedYear& year) {
  Eigen::Index dim = 0, bright = 0;
  const Eigen::ArrayXf factors = year.report.daylight_factor.head(year.report.rooms.front().count);
  factors.minCoeff(&dim);
  factors.maxCoeff(&bright);
  // Sensors may lie on the floor itself.
  constexpr double off_the_floor = 1e-3;  // m
  const Eigen::Vector3d from =
      year.sensors[static_cast<std::size_t>(dim)].position + off_the_floor * study.up;
  const Eigen::Vector3d& to = year.sensors[static_cast<std::size_t>(bright)].position;
  const ElementCaster& caster = of.model->caster();
  const auto free_way = [&](const Eigen::Vector3d& direction) {
    const Ray ray{.origin = from, .direction = direction};
    ElementHit hit;
    caster.closest_elements({&ray, 1}, {&hit, 1});
    return hit.facet < 0 ? eye_height : double{hit.t};
  };
  const double above_floor = free_way(-study.up), below_ceiling = free_way(study.up);
  constexpr double most_of_room = 0.6;  // of the height that is left below a low ceiling
  const double rise = std::clamp(eye_height - above_floor, 0.0, most_of_room * below_ceiling);
  Camera camera;
  camera.name = "room";
  camera.position = from + rise * study.up;
  Eigen::Vector3d level = to - from;
  level -= level.dot(study.up) * study.up;
  if (!(level.norm() > 1e-6)) level = -study.north;
  camera.direction = level.normalized();
  camera.up = study.up;
  camera.fov_degrees = 70.0;
  camera.width = 1024;
  camera.height = 768;
  return camera;
}

}  // namespace

void check_walk(const DaylightStudy& study, std::span<const SkyHour> hours) {
  constexpr int fewest_bands = 1;  // of a grey scene; find_year_basis() knows them
  check_year_basis(build_patches(study.scene, study.options.mesh), fewest_bands, hours);
}

WrittenWalk write_walk(const std::filesystem::path& page, const DaylightStudy& study,
                       const StudiedModel& of, const StudiedYear& year) {
  const YearBasis basis = find_year_basis(*of.model, year.hours, study.ground_reflectance);
  report(of.model->options().progress, "page", 0.0);
  Scene scene = study.scene;
  if (scene.cameras.empty()) scene.cameras.push_back(view_of_room(study, of, year));
  const Provenance provenance{.version = study.version,
                              .scene_file = study.scene.file.filename().string()};
  const BakedModel baked = bake_year({.model = *of.model,
                                      .basis = basis,
                                      .hours = year.hours,
                                      .weather = study.weather,
                                      .ground_reflectance = study.ground_reflectance},
                                     scene, provenance, study.clean_up.names.get());
  write_walkthrough(page, baked);
  return {.vertices = baked.vertex_count(), .terms = basis.term_count(), .error = basis.error};
}

}  // namespace lightwell
