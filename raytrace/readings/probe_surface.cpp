#include "raytrace/readings/probe_surface.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
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

// Distance, over the reach, at which a probe stands clear of the surfaces beside it.
constexpr double hair_of_reach = 0.1;

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

// Eight steps around the normal that `a` and `b` are at right angles to.
std::array<Eigen::Vector3d, 8> steps_around(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return {a, b, -a, -b, a + b, a - b, b - a, -a - b};
}

}  // namespace

ProbeSurface::ProbeSurface(const ElementCaster& caster)
    : caster_(caster), reach_(reach_in(scenery_bounds(caster.mesh()).diagonal())) {}

std::optional<ProbeSurface::Found> ProbeSurface::find(const Probe& probe) const {
  Frame frame{.normal = probe.normal};
  tangent_frame(probe.normal, frame.a, frame.b);
  const double hair = hair_of_reach * reach_;
  auto straight = below(probe.position, probe.normal);
  if (straight && is_inside(*straight, probe.position, frame, hair)) return straight;
  std::optional<Found> behind;
  for (const Eigen::Vector3d& step : steps_around(frame.a, frame.b)) {
    const Eigen::Vector3d moved = probe.position + hair * step;
    auto point_on_surface = below(moved, probe.normal);
    if (!point_on_surface || !is_inside(*point_on_surface, moved, frame, 0.5 * hair)) continue;
    if (!is_behind(moved, -hair * step, frame)) return point_on_surface;
    if (!behind) behind = point_on_surface;
  }
  // Only the inside of a body that stands a little above the floor is within reach.
  const Eigen::Vector3d beside = beside_surfaces(probe);
  if (beside != probe.position) return below(beside, probe.normal);
  return behind ? behind : straight;
}

GatherPoint ProbeSurface::point(const Probe& probe, const std::optional<Found>& found) const {
  if (!found) return {.position = beside_surfaces(probe), .normal = probe.normal};
  return {.position = found->position, .normal = probe.normal, .facet = found->hit.facet};
}

// Returns the position of a probe in the air, moved off the surfaces that stand within a hair of
// the probe. Rounding puts a probe at such a surface on either side of the surface: rays would
// start within a closed body, or in the plane that hides all lamps.
Eigen::Vector3d ProbeSurface::beside_surfaces(const Probe& probe) const {
  const double hair = hair_of_reach * reach_;
  Eigen::Vector3d at = probe.position, a, b;
  tangent_frame(probe.normal, a, b);
  // Behind a corner the probe comes off one wall after the other.
  constexpr int walls = 2;
  for (int wall = 0; wall < walls; ++wall) {
    for (const Eigen::Vector3d& way : steps_around(a, b)) at = off_surface(at, hair * way);
  }
  return at;
}

// Returns the position, moved off the first surface that stands between `at` - `way` and `at` +
// `way`.
Eigen::Vector3d ProbeSurface::off_surface(const Eigen::Vector3d& at,
                                          const Eigen::Vector3d& way) const {
  const Ray ray{.origin = at - way, .direction = way, .t_max = 2.0};
  ElementHit hit;
  caster_.closest_hits({&ray, 1}, {&hit, 1});
  if (hit.facet < 0) return at;
  const Eigen::Vector3d met = ray.origin + hit.t * way;
  Eigen::Vector3d normal = hit_normal(caster_.mesh(), hit, met);
  if ((normal.dot(way) > 0.0) != hit.from_back) normal = -normal;
  double before = (at - met).dot(normal);
  // The opposite ray meets the back of this surface, and tells whether the back is black.
  if (before < 0.0 && !hit.from_back) return at;
  if (before < 0.0 && hit.element >= 0 && faces_front(met, -normal, hit.facet)) {
    normal = -normal;
    before = -before;
  }
  if (before >= 0.5 * hair_of_reach * reach_) return at;
  return at + (room_before(met, normal, hit.facet) - before) * normal;
}

// Returns whether the back of a facet looks at the front of a surface, as a sheet between two rooms
// does. The back of a closed body's facet looks at backs, and that of a room's wall at nothing.
bool ProbeSurface::faces_front(const Eigen::Vector3d& at, const Eigen::Vector3d& way,
                               int facet) const {
  const Ray ray{.origin = at, .direction = way, .origin_group = facet};
  ElementHit hit;
  caster_.closest_hits({&ray, 1}, {&hit, 1});
  return hit.facet >= 0 && !hit.from_back;
}

// Returns the distance before a point of a facet that a probe is moved to: a hair, or half of a
// narrower gap.
double ProbeSurface::room_before(const Eigen::Vector3d& at, const Eigen::Vector3d& normal,
                                 int facet) const {
  const double hair = hair_of_reach * reach_;
  const Ray ray{.origin = at, .direction = normal, .t_max = 2.0 * hair, .origin_group = facet};
  ElementHit hit;
  caster_.closest_hits({&ray, 1}, {&hit, 1});
  return hit.facet >= 0 && !hit.from_back ? 0.5 * hit.t : hair;
}

bool ProbeSurface::is_behind_surface(const Probe& probe) const {
  const Ray ray{
      .origin = beside_surfaces(probe), .direction = probe.normal, .t_max = behind_share * reach_};
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
  for (const Probe& probe : probes) points.push_back(surface.point(probe, surface.find(probe)));
  return points;
}

}  // namespace lightwell
