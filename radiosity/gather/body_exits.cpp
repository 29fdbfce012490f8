#include "radiosity/gather/body_exits.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "mesh/patches/patch_sampler.h"
#include "mesh/patches/round_grid.h"
#include "scene/sampling.h"

namespace lightwell {
namespace {

using Eigen::Vector3d;
using Way = BodyExits::Way;

std::vector<Way> ways_from(const PatchMesh& mesh, int vertex, int facet) {
  std::vector<Way> ways;
  for (const auto face : mesh.elements->vf_range(HalfedgeMesh::VertexHandle(vertex))) {
    const int e = face.idx();
    if (mesh.facet[e] != facet) continue;
    for (int i = 0; i < mesh.corner_count(e); ++i) {
      if (mesh.corners[e][i] == vertex) continue;
      ways.push_back({mesh.patch[e], mesh.position(mesh.corners[e][i])});
    }
  }
  return ways;
}

// The ray along a way. The ray ends before its own shape, which the way meets at the other corner.
Ray ray_along(const GatherPoint& from, const Vector3d& to) {
  constexpr double far = 0.999;
  return {.origin = from.position,
          .direction = to - from.position,
          .t_max = far,
          .origin_group = from.facet};
}

// The point of the same shape at a place near it, on the side of a patch.
GatherPoint point_near(const PatchMesh& mesh, const Way& way, int facet, const Vector3d& place) {
  const RoundGrid& grid = *round_grid_of(mesh, facet);
  const Vector3d at = nearest_on(grid.shape, place);
  return {.position = at, .normal = round_normal(mesh, grid, way.patch, at), .facet = facet};
}

// A cosine-distributed ray of an even sequence (Roberts 2018, "R2"), the same for all vertices.
Ray even_ray(const GatherPoint& from, int number) {
  constexpr double along = 0.7548776662466927, across = 0.5698402909980532;
  const auto part = [&](double step) {
    const double sum = 0.5 + number * step;
    return static_cast<float>(sum - std::floor(sum));
  };
  Vector3d a, b;
  tangent_frame(from.normal, a, b);
  const Vector3d d = cosine_direction(part(along), part(across));
  return {.origin = from.position,
          .direction = d.x() * a + d.y() * b + d.z() * from.normal,
          .origin_group = from.facet};
}

GatherPoint place_of(const PatchMesh& mesh, const Ray& ray, const ElementHit& hit) {
  const Vector3d at = ray.origin + hit.t * ray.direction;
  if (const RoundGrid* grid = round_grid_of(mesh, hit.facet)) {
    return {.position = at,
            .normal = round_normal(mesh, *grid, mesh.patch[hit.element], at),
            .facet = hit.facet};
  }
  return {.position = at, .normal = element_center(mesh, hit.element).normal, .facet = hit.facet};
}

}  // namespace

BodyExits::BodyExits(const LitScene& lit)
    : caster_(lit.caster), has_sky_(lit.direct_light.dome() != nullptr) {
  if (lit.mesh().round_grids.empty()) return;
  for (const FacetRef& facet : scene_facets(lit.scene)) {
    const Surface& surface = lit.scene.surfaces[static_cast<std::size_t>(facet.surface)];
    const Material& material = lit.scene.materials[static_cast<std::size_t>(surface.material)];
    is_clear_.push_back(
        material.dielectric || material.passes_straight() || material.is_translucent() ? 1 : 0);
  }
}

// True if a way out of a body leaves the body there.
bool BodyExits::is_cover(const ElementHit& hit) const {
  return hit.facet >= 0 && hit.from_back && is_clear_[static_cast<std::size_t>(hit.facet)] == 0;
}

// A place `height` above a point, or half as high as whatever is above.
Vector3d BodyExits::place_above(const GatherPoint& point, double height) const {
  const Ray ray{.origin = point.position,
                .direction = point.normal,
                .t_max = 2.0 * height,
                .origin_group = point.facet};
  ElementHit hit;
  caster_.closest_elements({&ray, 1}, {&hit, 1});
  return point.position + (hit.facet < 0 ? height : 0.5 * hit.t) * point.normal;
}

// True if no diffuse path from a covered vertex comes to where a place outside is seen. The paths
// must meet backs, as in a body: a room meets the backs of none of its walls but of what divides
// it from others.
bool BodyExits::is_apart(const GatherPoint& covered, const Vector3d& place) const {
  constexpr int paths = 8, bounces = 6;
  int met = 0, backs = 0;
  for (int path = 0; path < paths; ++path) {
    GatherPoint at = covered;
    for (int bounce = 0; bounce < bounces; ++bounce) {
      const Ray ray = even_ray(at, path * bounces + bounce);
      ElementHit hit;
      caster_.closest_elements({&ray, 1}, {&hit, 1});
      if (hit.facet < 0 && has_sky_) return false;
      if (hit.facet < 0) break;
      ++met;
      backs += hit.from_back ? 1 : 0;
      if (hit.element < 0) break;
      at = place_of(caster_.mesh(), ray, hit);
      const Vector3d way = place - at.position;
      if (!(way.dot(at.normal) > 0.0)) continue;
      const Ray back{
          .origin = at.position, .direction = way, .t_max = 1.0, .origin_group = at.facet};
      std::uint8_t is_blocked = 0;
      caster_.occluded({&back, 1}, {&is_blocked, 1});
      if (is_blocked == 0) return false;
    }
  }
  // An open box on a floor: the paths meet the floor's front at every other end if the box is flat.
  return 3 * backs >= met;
}

// The first point along a way that begins in a body at `from`, and leaves the body at `hit`, from
// which the rest of the way meets no back; empty if there is none.
std::optional<GatherPoint> BodyExits::exit_along(const Way& way, const GatherPoint& from,
                                                 ElementHit hit) const {
  // The straight way runs below the round shape, which may leave the body later.
  constexpr int most_steps = 8;
  constexpr double share = 0.02;  // of the way, by which the point is clear of the body
  GatherPoint at = from;
  for (int step = 0; step < most_steps; ++step) {
    const double along = std::min(1.0, hit.t + share);
    at = point_near(caster_.mesh(), way, from.facet, at.position + along * (way.to - at.position));
    const Ray ray = ray_along(at, way.to);
    caster_.closest_elements({&ray, 1}, {&hit, 1});
    if (!is_cover(hit)) return at;
  }
  return std::nullopt;
}

// Outside of the body that covers a point, the first place along the ways; empty if none does.
std::optional<GatherPoint> BodyExits::nearest_exit(const std::vector<Way>& ways,
                                                   const GatherPoint& point) const {
  std::vector<Ray> rays;
  for (const Way& way : ways) rays.push_back(ray_along(point, way.to));
  std::vector<ElementHit> hits(rays.size());
  caster_.closest_elements(rays, hits);
  std::optional<GatherPoint> nearest;
  double off = 0.0;
  for (std::size_t i = 0; i < ways.size(); ++i) {
    if (!is_cover(hits[i])) continue;
    const std::optional<GatherPoint> exit = exit_along(ways[i], point, hits[i]);
    if (!exit) continue;
    const double distance = (exit->position - point.position).norm();
    if (nearest && distance >= off) continue;
    nearest = exit;
    off = distance;
  }
  if (!nearest || !is_apart(point, place_above(*nearest, off))) return std::nullopt;
  return nearest;
}

GatherPoint BodyExits::outside(int vertex, const GatherPoint& point) const {
  const PatchMesh& mesh = caster_.mesh();
  if (is_clear_.empty() || point.facet < 0 || !round_grid_of(mesh, point.facet)) return point;
  return nearest_exit(ways_from(mesh, vertex, point.facet), point).value_or(point);
}

bool BodyExits::covers(const PatchPoint& point) const {
  const PatchMesh& mesh = caster_.mesh();
  const int facet = mesh.facet[point.element];
  if (is_clear_.empty() || !round_grid_of(mesh, facet)) return false;
  // The light of vertices around comes from outside where one of their neighbours is there.
  std::vector<Way> ways;
  for (int i = 0; i < mesh.corner_count(point.element); ++i) {
    const std::vector<Way> further = ways_from(mesh, mesh.corners[point.element][i], facet);
    ways.insert(ways.end(), further.begin(), further.end());
  }
  return nearest_exit(ways, {point.position, point.normal, facet}).has_value();
}

}  // namespace lightwell
