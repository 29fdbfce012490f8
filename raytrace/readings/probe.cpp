#include "raytrace/readings/probe.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "mesh/patches/round_grid.h"
#include "radiosity/openings/portals.h"
#include "radiosity/refine/illuminance_bound.h"
#include "radiosity/sky/sky_light.h"
#include "raytrace/readings/read_error.h"
#include "raytrace/readings/specular_light.h"
#include "raytrace/readings/sure_gather.h"
#include "scene/errors.h"
#include "scene/sampling.h"

namespace lightwell {
namespace {

// Greatest distance of a probe from its surface, as a share of the scene's diagonal.
constexpr double reach_share = 1e-4;

double diagonal(const PatchMesh& mesh) {
  Eigen::AlignedBox3d box;
  for (int v = 0; v < mesh.vertex_count(); ++v) box.extend(mesh.position(v));
  return box.isEmpty() ? 0.0 : box.diagonal().norm();
}

// Unit normal at a hit, on the side of the probe or the opposite one. The back of a one-sided
// surface has no element, so the normal is that of its front.
Eigen::Vector3d hit_normal(const PatchMesh& mesh, const ElementHit& hit,
                           const Eigen::Vector3d& at) {
  if (const RoundGrid* grid = round_grid_of(mesh, hit.facet)) return front_normal(grid->shape, at);
  if (hit.element >= 0) return element_center(mesh, hit.element).normal;
  for (int e = 0; e < mesh.element_count(); ++e) {
    if (mesh.facet[e] == hit.facet) return element_center(mesh, e).normal;
  }
  return Eigen::Vector3d::Zero();
}

// Search for the surface that a probe lies on.
class ProbeSurface {
 public:
  struct SurfacePoint {
    ElementHit hit{};
    Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< on the surface
  };

  explicit ProbeSurface(const ElementCaster& caster)
      : caster_(caster), reach_(reach_share * diagonal(caster.mesh())) {}

  // Returns the surface point of a probe; empty if there is none. A probe on an edge, or where
  // another surface stands on its own surface, is moved by a tenth of the reach to a point that
  // lies clearly within its facet and in front of what stands there.
  std::optional<SurfacePoint> find(const Probe& probe) const {
    Frame frame{.normal = probe.normal};
    tangent_frame(probe.normal, frame.a, frame.b);
    const double hair = 0.1 * reach_;
    auto straight = below(probe.position, probe.normal);
    if (straight && is_inside(*straight, probe.position, frame, hair)) return straight;
    std::optional<SurfacePoint> behind;
    const Eigen::Vector3d &a = frame.a, &b = frame.b;
    for (const Eigen::Vector3d& step :
         {a, b, Eigen::Vector3d(-a), Eigen::Vector3d(-b), Eigen::Vector3d(a + b),
          Eigen::Vector3d(a - b), Eigen::Vector3d(b - a), Eigen::Vector3d(-a - b)}) {
      const Eigen::Vector3d moved = probe.position + hair * step;
      auto point_on_surface = below(moved, probe.normal);
      if (!point_on_surface || !is_inside(*point_on_surface, moved, frame, 0.5 * hair)) continue;
      if (!is_behind(moved, -hair * step, frame)) return point_on_surface;
      if (!behind) behind = point_on_surface;
    }
    return behind ? behind : straight;
  }

 private:
  struct Frame {
    Eigen::Vector3d normal, a{}, b{};  // a and b are tangent to the surface
  };

  // Returns the nearest point of the surfaces within reach above or below `position` that face
  // along `normal` or against it. Surfaces with an element come before black backs.
  std::optional<SurfacePoint> below(const Eigen::Vector3d& position,
                                    const Eigen::Vector3d& normal) const {
    constexpr double min_facing = 0.9;  // cosine; excludes a wall touched from the side
    constexpr int max_layers = 8;
    std::optional<SurfacePoint> best;
    double best_distance = 0.0;
    const Eigen::Vector3d top = position + reach_ * normal;
    Ray ray{.origin = top, .direction = -normal, .t_max = 2.0 * reach_};
    for (int layer = 0; layer < max_layers; ++layer) {
      ElementHit hit;
      caster_.closest_hits({&ray, 1}, {&hit, 1});
      if (hit.facet < 0) break;
      const Eigen::Vector3d at = ray.origin + hit.t * ray.direction;
      const double distance = std::abs((at - position).dot(normal));
      const bool faces = std::abs(hit_normal(caster_.mesh(), hit, at).dot(normal)) > min_facing;
      const bool is_better =
          !best || (hit.element >= 0 && best->hit.element < 0) ||
          ((hit.element >= 0) == (best->hit.element >= 0) && distance < best_distance);
      if (faces && is_better) {
        best = SurfacePoint{.hit = hit, .position = at};
        best_distance = distance;
      }
      // The next ray starts a little before this surface, since another may lie in the same plane.
      ray.origin = at + 1e-3 * reach_ * normal;
      ray.t_max = 2.0 * reach_ - (top - ray.origin).dot(normal);
      ray.origin_group = hit.facet;
    }
    return best;
  }

  // Returns whether the facet continues for `radius` around the point and nothing stands on it
  // there. A neighbour in nearly the same plane ends the facet, since the neighbour would shade the
  // probe at their common edge.
  bool is_inside(const SurfacePoint& point_on_surface, const Eigen::Vector3d& position,
                 const Frame& frame, double radius) const {
    const auto continues = [&](const Eigen::Vector3d& at) {
      const auto other = below(at, frame.normal);
      return other && other->hit.facet == point_on_surface.hit.facet;
    };
    for (const Eigen::Vector3d& along : {frame.a, frame.b}) {
      const Ray ray{.origin = position + reach_ * frame.normal - radius * along,
                    .direction = along,
                    .t_max = 2.0 * radius};
      std::uint8_t blocked = 0;
      caster_.occluded({&ray, 1}, {&blocked, 1});
      if (blocked || !continues(position - radius * along) ||
          !continues(position + radius * along)) {
        return false;
      }
    }
    return true;
  }

  // Returns whether the first surface that stands between the point and point + 2 `way` shows its
  // back.
  bool is_behind(const Eigen::Vector3d& position, const Eigen::Vector3d& way,
                 const Frame& frame) const {
    const Ray ray{.origin = position + reach_ * frame.normal, .direction = way, .t_max = 2.0};
    ElementHit hit;
    caster_.closest_hits({&ray, 1}, {&hit, 1});
    return hit.facet >= 0 && hit.from_back;
  }

  const ElementCaster& caster_;
  double reach_;
};

}  // namespace

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

/// Caustics at probes, which the mesh holds.
struct Caustics {
  BandArray irradiance{};       ///< probes x bands, W/m^2
  Eigen::ArrayXd lux_within{};  ///< bound of their error, lx
};

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
                       const GatherOptions& options, const Caustics& caustics,
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
  bounds->lux_within = (sure.lux_within.square() + caustics.lux_within.square()).sqrt();
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

struct MirroredLight {
  BandArray irradiance{};       // points x bands, W/m^2
  Eigen::ArrayXd lux_within{};  // lx, with odds of about 19 to 1
};

// Light of lamps by way of mirrors and glass at the points that lie on no surface: the mesh holds
// such light for surfaces. `accuracy` is that of ProbeBounds.
MirroredLight mirrored_in_air(const LitScene& lit, const RadiositySolution& solution,
                              const std::vector<GatherPoint>& points, const GatherOptions& options,
                              double accuracy) {
  std::vector<GatherPoint> in_air;
  std::vector<Eigen::Index> row;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (points[i].facet >= 0) continue;
    row.push_back(static_cast<Eigen::Index>(i));
    in_air.push_back(points[i]);
    if (!in_air.back().key) in_air.back().key = i;
  }
  const auto count = static_cast<Eigen::Index>(points.size());
  MirroredLight result{.irradiance = BandArray::Zero(count, lit.scene.bands.count()),
                       .lux_within = Eigen::ArrayXd::Zero(count)};
  if (in_air.empty()) return result;
  SpecularLightOptions effort{
      .most_rays = 32 * options.rays, .replica = options.replica, .progress = options.run.progress};
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
  Caustics caustics{.irradiance = BandArray::Zero(count, scene.bands.count()),
                    .lux_within = Eigen::ArrayXd::Zero(count)};
  std::vector<GatherPoint> points;
  points.reserve(probes.size());
  for (const Probe& probe : probes) {
    GatherPoint point{.position = probe.position, .normal = probe.normal};
    if (const auto point_on_surface = surface.find(probe)) {
      point.position = point_on_surface->position;
      point.facet = point_on_surface->hit.facet;
      if (has_caustics && point_on_surface->hit.element >= 0) {
        const auto row = static_cast<Eigen::Index>(points.size());
        caustics.irradiance.row(row) =
            interpolate(caster.mesh(), solution.caustic_irradiance, point_on_surface->hit)
                .transpose();
        caustics.lux_within[row] = caustic_bound(caster.mesh(), solution, point_on_surface->hit);
      }
    }
    points.push_back(point);
  }
  const BandArray B = gatherable_radiosity(caster.mesh(), direct_light, solution);
  const LitScene lit{scene, caster, direct_light};
  const MirroredLight mirrored =
      mirrored_in_air(lit, solution, points, options, bounds ? bounds->accuracy : 0.0);
  BandArray E = probe_gather(lit, B, points, options, caustics, solution, bounds);
  E += caustics.irradiance + mirrored.irradiance;
  if (bounds) {
    bounds->lux_within = (bounds->lux_within.square() + mirrored.lux_within.square()).sqrt();
  }
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
