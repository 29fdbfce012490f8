#include "radiosity/gather/vertex_points.h"

#include <algorithm>
#include <cmath>
#include <memory>

#include "mesh/patches/inset.h"
#include "mesh/patches/patch_sampler.h"
#include "mesh/patches/round_grid.h"
#include "radiosity/gather/gap_sizes.h"

namespace lightwell {
namespace {

// Surfaces nearer than this share of the way to the element's centre lie on each other.
constexpr double nearest = 1e-4;

// The point of facets that meet smoothly: `height` above a point on one of them, or half as high as
// whatever is above. On surfaces that lie on each other the point stays on its facet.
GatherPoint risen(const ElementCaster& caster, const GatherPoint& on_facet,
                  const Eigen::Vector3d& normal, double height, double to_center) {
  const Ray ray{.origin = on_facet.position,
                .direction = normal,
                .t_max = 2.0 * height,
                .origin_group = on_facet.facet};
  ElementHit hit;
  caster.closest_elements({&ray, 1}, {&hit, 1});
  const bool is_clear = hit.facet < 0;
  if (!is_clear && !(hit.t > nearest * to_center)) return on_facet;
  const double free = is_clear ? height : std::min(height, 0.5 * hit.t);
  return {.position = on_facet.position + free * normal, .normal = normal};
}

}  // namespace

VertexGatherPoints::VertexGatherPoints(const PatchMesh& mesh)
    : mesh_(mesh), element_(vertex_elements(mesh)) {}

GatherPoint VertexGatherPoints::on_facet(int vertex) const {
  // Share of the way to the element's centre: far enough for the float rounding of a room-sized
  // scene, and near enough to stand for the vertex.
  constexpr double share = 0.02;
  const int e = element_[vertex];
  if (e < 0) return {};
  const PatchPoint center = element_center(mesh_, e);
  const Eigen::Vector3d p = mesh_.position(vertex),
                        inwards = inset_share(mesh_, e, share) * (center.position - p);
  // The element of a round shape is a chord of it, so the point is moved to the surface.
  if (const RoundGrid* grid = round_grid_of(mesh_, mesh_.facet[e])) {
    const Eigen::Vector3d at = nearest_on(grid->shape, p + inwards);
    return {.position = at,
            .normal = round_normal(mesh_, *grid, mesh_.patch[e], at),
            .facet = mesh_.facet[e]};
  }
  return {.position = p + inwards, .normal = center.normal, .facet = mesh_.facet[e]};
}

std::optional<Eigen::Vector3d> VertexGatherPoints::common_normal(int vertex) const {
  // Lamps are left out: a point before one would receive the lamp's own light.
  constexpr double flat = 1.0 - 4e-6;  // cosine of 0.16 degrees
  const int e = element_[vertex];
  if (e < 0 || round_grid_of(mesh_, mesh_.facet[e])) return std::nullopt;
  const Eigen::Vector3d& of_all = mesh_.vertex_normal[vertex];
  if (of_all.dot(element_center(mesh_, e).normal) >= flat) return std::nullopt;
  if ((mesh_.emission.row(mesh_.patch[e]) > 0.0f).any()) return std::nullopt;
  return of_all;
}

GatherPoint VertexGatherPoints::operator[](int vertex) const {
  const GatherPoint at = on_facet(vertex);
  const std::optional<Eigen::Vector3d> normal = common_normal(vertex);
  if (!normal) return at;
  // The point lies so far above the facets that none hides light from above its horizon.
  const double height = (at.position - mesh_.position(vertex)).norm();
  return {.position = at.position + height * *normal, .normal = *normal};
}

Eigen::Vector3d VertexGatherPoints::center(int vertex) const {
  const int e = element_[vertex];
  return e < 0 ? mesh_.position(vertex) : element_center(mesh_, e).position;
}

std::vector<GatherPoint> vertex_gather_points(const PatchMesh& mesh) {
  const VertexGatherPoints at(mesh);
  std::vector<GatherPoint> points;
  points.reserve(static_cast<std::size_t>(mesh.vertex_count()));
  for (int v = 0; v < mesh.vertex_count(); ++v) points.push_back(at[v]);
  return points;
}

double gap_reach(const PatchMesh& mesh, int element, const Eigen::Vector3d& vertex) {
  // The corners of a rectangle of 1 : 4 are 4.1 times as far from the centre as the sides, and
  // those of half a square at most 4.2 times.
  constexpr double slimmest = 4.25;
  return std::min((element_center(mesh, element).position - vertex).norm(),
                  slimmest * off_border(mesh, element));
}

GatherPoint moved_into_gap(const ElementCaster& caster, const Eigen::Vector3d& vertex, double reach,
                           const GatherPoint& point) {
  if (point.facet < 0) return point;
  const Eigen::Vector3d way = point.position - vertex;
  constexpr double narrow = 0.3;  // share of the reach
  if (!(reach > 0.0 && way.norm() > 0.0)) return point;
  const Ray ray{.origin = point.position,
                .direction = point.normal,
                .t_max = narrow * reach,
                .origin_group = point.facet};
  ElementHit hit;
  caster.closest_elements({&ray, 1}, {&hit, 1});
  if (hit.element < 0 || !(hit.t > nearest * reach)) return point;
  const Eigen::Vector3d normal = element_center(caster.mesh(), hit.element).normal;
  if (std::abs(normal.dot(point.normal)) < -facing) return point;
  GatherPoint moved = point;
  moved.position = vertex + std::max(1.0, hit.t / way.norm()) * way;
  return moved;
}

GatherPoints vertex_points(const ElementCaster& caster) {
  const auto all = std::make_shared<VertexGatherPoints>(caster.mesh());
  return {caster.mesh().vertex_count(), [all, &caster](int v) {
            const PatchMesh& mesh = caster.mesh();
            const Eigen::Vector3d vertex = mesh.position(v);
            const GatherPoint on_facet = all->on_facet(v);
            const int element = all->element(v);
            const double reach = element < 0 ? 0.0 : gap_reach(mesh, element, vertex);
            const GatherPoint at = moved_into_gap(caster, vertex, reach, on_facet);
            const std::optional<Eigen::Vector3d> normal = all->common_normal(v);
            if (!normal) return at;
            return risen(caster, at, *normal, (on_facet.position - vertex).norm(),
                         (all->center(v) - vertex).norm());
          }};
}

}  // namespace lightwell
