#include "raytrace/readings/probe_surface.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "mesh/patches/mesh_bounds.h"
#include "mesh/patches/round_grid.h"
#include "scene/sampling.h"

namespace lightwell {
namespace {

// Greatest distance of a probe from its surface, m, for a scene's diagonal. Where a facet lies
// kilometres away, a share of the diagonal would reach from a desk to the floor below. Single
// precision rounds coordinates to 6e-8 of the diagonal.
double reach_in(double diagonal) {
  constexpr double share = 1e-4, most = 0.02, of_rounding = 2e-6;
  return std::min(share * diagonal, std::max(most, of_rounding * diagonal));
}
// Greatest distance at which a probe is taken to be meant for the surface before it, over the
// reach.
constexpr double behind_share = 10.0;

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

}  // namespace

ProbeSurface::ProbeSurface(const ElementCaster& caster)
    : caster_(caster), reach_(reach_in(scenery_bounds(caster.mesh()).diagonal())) {}

std::optional<ProbeSurface::Found> ProbeSurface::find(const Probe& probe) const {
  Frame frame{.normal = probe.normal};
  tangent_frame(probe.normal, frame.a, frame.b);
  const double hair = 0.1 * reach_;
  auto straight = below(probe.position, probe.normal);
  if (straight && is_inside(*straight, probe.position, frame, hair)) return straight;
  std::optional<Found> behind;
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

bool ProbeSurface::is_behind_surface(const Probe& probe) const {
  const Ray ray{
      .origin = probe.position, .direction = probe.normal, .t_max = behind_share * reach_};
  ElementHit hit;
  caster_.closest_hits({&ray, 1}, {&hit, 1});
  return hit.facet >= 0 && hit.from_back;
}

// Returns the nearest point of the surfaces within reach above or below `position` that face
// along `normal` or against it. Surfaces with an element come before black backs.
std::optional<ProbeSurface::Found> ProbeSurface::below(const Eigen::Vector3d& position,
                                                       const Eigen::Vector3d& normal) const {
  constexpr double min_facing = 0.9;  // cosine; excludes a wall touched from the side
  constexpr int max_layers = 8;
  std::optional<Found> best;
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
      best = Found{.hit = hit, .position = at};
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
bool ProbeSurface::is_inside(const Found& point_on_surface, const Eigen::Vector3d& position,
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
    if (blocked || !continues(position - radius * along) || !continues(position + radius * along)) {
      return false;
    }
  }
  return true;
}

// Returns whether the first surface that stands between the point and point + 2 `way` shows its
// back.
bool ProbeSurface::is_behind(const Eigen::Vector3d& position, const Eigen::Vector3d& way,
                             const Frame& frame) const {
  const Ray ray{.origin = position + reach_ * frame.normal, .direction = way, .t_max = 2.0};
  ElementHit hit;
  caster_.closest_hits({&ray, 1}, {&hit, 1});
  return hit.facet >= 0 && hit.from_back;
}

GatherPoint probe_point(const Probe& probe, const std::optional<ProbeSurface::Found>& found) {
  GatherPoint point{.position = probe.position, .normal = probe.normal};
  if (found) {
    point.position = found->position;
    point.facet = found->hit.facet;
  }
  return point;
}

std::vector<int> probes_behind_surfaces(const ElementCaster& caster,
                                        std::span<const Probe> probes) {
  const ProbeSurface surface(caster);
  std::vector<int> behind;
  for (std::size_t i = 0; i < probes.size(); ++i) {
    if (surface.is_behind_surface(probes[i]) && !surface.find(probes[i])) {
      behind.push_back(static_cast<int>(i));
    }
  }
  return behind;
}

std::vector<GatherPoint> probe_points(const ElementCaster& caster, std::span<const Probe> probes) {
  const ProbeSurface surface(caster);
  std::vector<GatherPoint> points;
  points.reserve(probes.size());
  for (const Probe& probe : probes) points.push_back(probe_point(probe, surface.find(probe)));
  return points;
}

}  // namespace lightwell
