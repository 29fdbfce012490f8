#include "scene/io/round_facets.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <utility>

#include "scene/io/placed_mesh.h"
#include "scene/io/remarks.h"
#include "scene/rotation_between.h"
#include "scene/round_shape.h"

namespace lightwell {
namespace {

using Eigen::Vector3d;

/// The plane and the bounds of a facet, a disc or a ring.
struct Flat {
  int surface = 0;
  Vector3d normal, point;
  Eigen::AlignedBox3d box;
};

Flat flat_of(int surface, const PolygonMesh& mesh, const Facet& facet) {
  Flat flat{.surface = surface, .normal = facet_normal(mesh, facet)};
  for (const int v : facet.boundary) flat.box.extend(mesh.vertices[static_cast<std::size_t>(v)]);
  flat.point = mesh.vertices[static_cast<std::size_t>(facet.boundary.front())];
  return flat;
}

/// True if two lie in one plane, within `tolerance`, m, and their boxes meet.
bool may_lie_on(const Flat& ring, const Flat& other, double tolerance) {
  if (ring.surface == other.surface) return false;
  constexpr double parallel = 1e-5;
  const Vector3d hair = Vector3d::Constant(tolerance);
  return ring.normal.cross(other.normal).norm() <= parallel &&
         std::abs(other.normal.dot(ring.point - other.point)) <= tolerance &&
         Eigen::AlignedBox3d(ring.box.min() - hair, ring.box.max() + hair).intersects(other.box);
}

/// The discs and rings of a scene, and the facets that may lie on them.
struct Flats {
  explicit Flats(const Scene& scene) {
    for (std::size_t s = 0; s < scene.surfaces.size(); ++s) {
      const auto* frustum = std::get_if<Frustum>(&scene.surfaces[s].shape);
      if (!frustum || !is_flat(*frustum)) continue;
      rings.push_back({.surface = static_cast<int>(s),
                       .normal = frustum->axis,
                       .point = frustum->base,
                       .box = bounds(*frustum)});
    }
    if (rings.empty()) return;
    tolerance = share_of_diagonal * scene_bounds(scene).diagonal();
    for (std::size_t s = 0; s < scene.surfaces.size(); ++s) {
      const auto* mesh = std::get_if<PolygonMesh>(&scene.surfaces[s].shape);
      if (!mesh) continue;
      for (const Facet& facet : mesh->facets) {
        polygons.push_back(flat_of(static_cast<int>(s), *mesh, facet));
      }
    }
  }

  bool lies_on_another(const Flat& ring) const {
    const auto is_on = [&](const Flat& other) { return may_lie_on(ring, other, tolerance); };
    return std::ranges::any_of(polygons, is_on) || std::ranges::any_of(rings, is_on);
  }

  static constexpr double share_of_diagonal = 2e-6;  // several roundings of rays
  std::vector<Flat> rings{}, polygons{};
  double tolerance = 0.0;
};

}  // namespace

Frustum frustum_about(const Vector3d& base, const Vector3d& axis, double height, double base_radius,
                      double top_radius, bool inward) {
  return {.base = base,
          .axis = axis.stableNormalized(),
          .height = height,
          .base_radius = base_radius,
          .top_radius = top_radius,
          .inward = inward};
}

Frustum placed_frustum(const Frustum& frustum, const Eigen::Affine3d& transform) {
  const double scale = std::cbrt(std::abs(transform.linear().determinant()));
  return frustum_about(transform * frustum.base, transform.linear() * frustum.axis,
                       scale * frustum.height, scale * frustum.base_radius,
                       scale * frustum.top_radius, frustum.inward);
}

PolygonMesh facets_of(const Frustum& frustum) {
  const Eigen::Affine3d place =
      Eigen::Translation3d(frustum.base) * rotation_between(Vector3d::UnitZ(), frustum.axis);
  const double base = frustum.base_radius, top = frustum.top_radius;
  if (is_flat(frustum)) {
    Polygon ring = ring_polygon(std::min(base, top), std::max(base, top));
    const bool is_turned = frustum.inward != (top > base);
    const auto put = [&](Loop& loop) {
      for (Vector3d& p : loop) p = place * p;
      if (is_turned) std::ranges::reverse(loop);
    };
    put(ring.boundary);
    std::ranges::for_each(ring.holes, put);
    MeshBuilder mesh;
    mesh.add(ring);
    return mesh.mesh();
  }
  Repairs none;
  const std::vector<Loop> loops = cone_loops(base, top, frustum.height);
  return placed_loops(loops, place, frustum.inward, none, {},
                      cone_normals(loops, base, top, frustum.height));
}

void replace_by_facets(Scene& scene) {
  Remarks remarks;
  const Flats flats(scene);
  std::vector<char> is_covered(scene.surfaces.size(), 0);
  for (const Flat& ring : flats.rings) {
    if (flats.lies_on_another(ring)) is_covered[static_cast<std::size_t>(ring.surface)] = 1;
  }
  for (std::size_t s = 0; s < scene.surfaces.size(); ++s) {
    Surface& surface = scene.surfaces[s];
    const auto* frustum = std::get_if<Frustum>(&surface.shape);
    if (!frustum) continue;
    const bool shines = scene.materials[static_cast<std::size_t>(surface.material)].is_emitter();
    if (!shines && is_covered[s] == 0) continue;
    remarks.add(shines ? "Cylinders, cones and rings that shine became 32 facets of the same area"
                       : "Discs and rings that lie on other surfaces became polygons of 32 corners "
                         "and the same area",
                surface.name);
    surface.shape = facets_of(*frustum);
  }
  remarks.report_to(scene);
}

}  // namespace lightwell
