#include "raytrace/readings/probe.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "radiosity/gather/gatherable_radiosity.h"
#include "radiosity/openings/portals.h"
#include "radiosity/refine/illuminance_bound.h"
#include "radiosity/sky/sky_light.h"
#include "raytrace/readings/probe_surface.h"
#include "raytrace/readings/read_error.h"
#include "raytrace/readings/specular_light.h"
#include "raytrace/readings/sure_gather.h"
#include "scene/errors.h"

namespace lightwell {
namespace {

// A probe is one point, so it can afford many rays to the sky. Openings between bright and dim
// parts are looked for if the options have none.
GatherOptions probe_options(const LitScene& lit, const BandArray& radiosity,
                            GatherOptions options) {
  constexpr int per_ray = 4, fewest = 64;
  options.aims_out_of_gaps = true;
  if (options.shadows.sky_rays == 0) {
    options.shadows.sky_rays =
        std::clamp(per_ray * std::min(options.rays, most_sky_rays), fewest, most_sky_rays);
  }
  if (!options.portals) {
    options.portals =
        find_portals(lit.scene, lit.caster, brightness_of_vertices(lit.mesh(), radiosity));
  }
  return options;
}

// Bound of the error that a gather takes over from the solution, as a multiple of read_errors().
constexpr double of_read_error = 1.0;

/// Light at probes that their gathers do not find: caustics, which the mesh holds, or that of lamps
/// by way of mirrors and glass in free space.
struct OtherLight {
  BandArray irradiance{};       ///< probes x bands, W/m^2
  Eigen::ArrayXd lux_within{};  ///< bound of its error, lx, with odds of about 19 to 1
};

// Bounds of the error of gathered and other light together. A gather that found no light has no
// bound (NaN), and adds none where there is other light.
Eigen::ArrayXd with_other_light(const Eigen::ArrayXd& gathered, const OtherLight& other) {
  const Eigen::Array<bool, Eigen::Dynamic, 1> is_lit = (other.irradiance > 0.0f).rowwise().any();
  const Eigen::ArrayXd known = (gathered.isNaN() && is_lit).select(0.0, gathered);
  return (known.square() + other.lux_within.square()).sqrt();
}

// Caustics have no estimate of their error. Where they vary little over an element, as lamps in a
// pane or a mirror do, their error is taken to be less than they are. The bound of a focus, whose
// shape the mesh does not follow, is the light of its brightest corner.
double caustic_bound(const PatchMesh& mesh, const RadiositySolution& solution,
                     const ElementHit& hit) {
  double most = 0.0;
  for (int c = 0; c < mesh.corner_count(hit.element); ++c) {
    const Spectrum here = solution.caustic_irradiance.row(mesh.corners[hit.element][c]).transpose();
    most = std::max(most, luminous(solution.bands, here));
  }
  return most;
}

// Light of the gather at the probes, without caustics; the error of `caustics` adds to the bounds.
BandArray probe_gather(const LitScene& lit, const BandArray& radiosity, const GatherPoints& points,
                       const GatherOptions& options, const OtherLight& caustics,
                       const RadiositySolution& solution, ProbeBounds* bounds) {
  const GatherOptions at_probes = probe_options(lit, radiosity, options);
  if (!bounds) {
    const GatheredIrradiance E = gather_irradiance(lit, radiosity, points, at_probes);
    return E.direct + E.indirect;
  }
  const SureGoal goal{
      .accuracy = bounds->accuracy,
      .besides = of_read_error * read_errors(lit, solution, radiosity, points, at_probes.rays)};
  SureIrradiance sure = sure_gather(lit, radiosity, points, at_probes, goal);
  bounds->lux_within = with_other_light(sure.lux_within, caustics);
  bounds->read_within = (goal.besides.square() + caustics.lux_within.square()).sqrt();
  bounds->missed = sure.missed;
  return std::move(sure.irradiance);
}

}  // namespace

SolveOptions options_for_probes() {
  // 64 rays suffice: the light of vertices is read by many rays of many probes, whose means average
  // out its noise.
  return {.gather = {.rays = 64, .shadows = {.min_rays = 16, .max_rays = 64}},
          .refine = {.tolerance = 0.0},
          .error_points = 0};
}

namespace {

// Points and their light.
struct LitPoints {
  const std::vector<GatherPoint>& points;
  const BandArray& irradiance;  // without that of lamps by way of mirrors and glass, W/m^2
};

// Light of lamps by way of mirrors and glass at the points that lie on no surface: the mesh holds
// such light for surfaces. `accuracy` is that of ProbeBounds.
OtherLight mirrored_in_air(const LitScene& lit, const RadiositySolution& solution,
                           const LitPoints& at, const GatherOptions& options, double accuracy) {
  const std::vector<GatherPoint>& points = at.points;
  SpecularLightOptions effort{
      .most_rays = 32 * options.rays, .replica = options.replica, .progress = options.run.progress};
  std::vector<GatherPoint> in_air;
  std::vector<Eigen::Index> row;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (points[i].facet >= 0) continue;
    row.push_back(static_cast<Eigen::Index>(i));
    in_air.push_back(points[i]);
    effort.other_light.push_back(at.irradiance.row(row.back()).cast<double>().mean());
    if (!in_air.back().key) in_air.back().key = i;
  }
  const auto count = static_cast<Eigen::Index>(points.size());
  OtherLight result{.irradiance = BandArray::Zero(count, lit.scene.bands.count()),
                    .lux_within = Eigen::ArrayXd::Zero(count)};
  if (in_air.empty()) return result;
  if (accuracy > 0.0) {
    // A quarter of the bound, which is two standard errors.
    effort.accuracy = std::min(effort.accuracy, accuracy / 8.0);
    effort.most_rays = 1 << 20;
  }
  const SpecularIrradiance E = specular_irradiance(lit, solution, in_air, effort);
  for (std::size_t k = 0; k < row.size(); ++k) {
    const auto from = static_cast<Eigen::Index>(k);
    const Spectrum found = E.irradiance.row(from).transpose();
    result.irradiance.row(row[k]) = found.transpose();
    if (!(found.mean() > 0.0f)) continue;
    const double lux_of_mean = luminous(lit.scene.bands, found) / static_cast<double>(found.mean());
    result.lux_within[row[k]] = 2.0 * lux_of_mean * std::sqrt(double{E.variance[from]});
  }
  return result;
}

}  // namespace

BandArray probe_irradiance(const Scene& scene, const ElementCaster& caster,
                           const DirectLight& direct_light, const RadiositySolution& solution,
                           std::span<const Probe> probes, const GatherOptions& options,
                           ProbeBounds* bounds) {
  const ProbeSurface surface(caster);
  const bool has_caustics = solution.caustic_irradiance.size() > 0;
  // Rays from the probe do not find light of emitters through mirrors and glass; the mesh holds
  // this light.
  const auto count = static_cast<Eigen::Index>(probes.size());
  OtherLight caustics{.irradiance = BandArray::Zero(count, scene.bands.count()),
                      .lux_within = Eigen::ArrayXd::Zero(count)};
  std::vector<GatherPoint> points;
  points.reserve(probes.size());
  for (const Probe& probe : probes) {
    const auto found = surface.find(probe);
    if (found && has_caustics && found->hit.element >= 0) {
      const auto row = static_cast<Eigen::Index>(points.size());
      caustics.irradiance.row(row) =
          interpolate(caster.mesh(), solution.caustic_irradiance, found->hit).transpose();
      caustics.lux_within[row] = caustic_bound(caster.mesh(), solution, found->hit);
    }
    points.push_back(surface.point(probe, found));
  }
  const LitScene lit{scene, caster, direct_light};
  const BandArray B = gatherable_radiosity(lit, solution);
  BandArray E = probe_gather(lit, B, points, options, caustics, solution, bounds);
  E += caustics.irradiance;
  const OtherLight mirrored =
      mirrored_in_air(lit, solution, {points, E}, options, bounds ? bounds->accuracy : 0.0);
  E += mirrored.irradiance;
  if (bounds) bounds->lux_within = with_other_light(bounds->lux_within, mirrored);
  return E;
}

namespace {

// Hits of probes on elements. Throws InputError that names the first probe without an element.
std::vector<ElementHit> on_elements(const ElementCaster& caster, const RadiositySolution& solution,
                                    std::span<const Probe> probes) {
  const ProbeSurface surface(caster);
  std::vector<ElementHit> hits;
  for (std::size_t i = 0; i < probes.size(); ++i) {
    const auto point_on_surface = surface.find(probes[i]);
    if (!point_on_surface || point_on_surface->hit.element < 0) {
      const Eigen::Vector3d p = probes[i].position / solution.metres_per_unit;
      throw InputError(fmt::format("probe {} at ({:g}, {:g}, {:g}) {} {}: {}", i + 1, p.x(), p.y(),
                                   p.z(), solution.unit_name,
                                   point_on_surface ? "lies on the back of a one-sided surface"
                                                    : "lies on no surface that faces its way",
                                   "there is nothing to interpolate; gather instead, or move it"));
    }
    hits.push_back(point_on_surface->hit);
  }
  return hits;
}

}  // namespace

BandArray interpolate_irradiance(const ElementCaster& caster, const RadiositySolution& solution,
                                 std::span<const Probe> probes) {
  const std::vector<ElementHit> hits = on_elements(caster, solution, probes);
  const BandArray E = solution.irradiance();
  BandArray result(static_cast<Eigen::Index>(probes.size()), E.cols());
  for (std::size_t i = 0; i < probes.size(); ++i) {
    result.row(static_cast<Eigen::Index>(i)) = interpolate(caster.mesh(), E, hits[i]).transpose();
  }
  return result;
}

Eigen::ArrayXd interpolation_bound(const ElementCaster& caster, const RadiositySolution& solution,
                                   std::span<const Probe> probes) {
  const Eigen::ArrayXf of_elements = illuminance_bounds(caster.mesh(), solution);
  if (of_elements.size() == 0) return {};
  const std::vector<ElementHit> hits = on_elements(caster, solution, probes);
  Eigen::ArrayXd result(static_cast<Eigen::Index>(probes.size()));
  for (std::size_t i = 0; i < probes.size(); ++i) {
    result[static_cast<Eigen::Index>(i)] = double{of_elements[hits[i].element]};
  }
  return result;
}

}  // namespace lightwell
