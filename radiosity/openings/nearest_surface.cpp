#include "radiosity/openings/nearest_surface.h"

#include <algorithm>
#include <variant>

#include "scene/sampling.h"

namespace lightwell {
namespace {

using Eigen::Vector2d, Eigen::Vector3d;

Vector2d nearest_on_segment(const Vector2d& a, const Vector2d& b, const Vector2d& p) {
  const Vector2d along = b - a;
  const double length2 = along.squaredNorm();
  const double s = length2 > 0.0 ? std::clamp((p - a).dot(along) / length2, 0.0, 1.0) : 0.0;
  return a + s * along;
}

bool crosses_ray(const Vector2d& a, const Vector2d& b, const Vector2d& p) {
  if ((a.y() > p.y()) == (b.y() > p.y())) return false;
  return p.x() < a.x() + (p.y() - a.y()) / (b.y() - a.y()) * (b.x() - a.x());
}

}  // namespace

NearestSurface::NearestSurface(const Scene& scene) {
  for (const Surface& surface : scene.surfaces) {
    const Material& material = scene.materials[static_cast<std::size_t>(surface.material)];
    if (material.dielectric || surface.motion >= 0) continue;
    if (const auto round = round_shape(surface)) {
      shapes_.push_back({.round = round, .box = bounds(*round)});
      continue;
    }
    const auto& mesh = std::get<PolygonMesh>(surface.shape);
    for (const Facet& facet : mesh.facets) shapes_.push_back(polygon(mesh, facet));
  }
  if (shapes_.empty()) return;
  std::vector<BoxTree::Box> boxes;
  for (const Shape& shape : shapes_) boxes.push_back(shape.box);
  tree_.emplace(std::move(boxes));
}

NearestSurface::Shape NearestSurface::polygon(const PolygonMesh& mesh, const Facet& facet) {
  const auto at = [&](int v) { return mesh.vertices[static_cast<std::size_t>(v)]; };
  Shape shape{.origin = at(facet.boundary.front()), .normal = facet_normal(mesh, facet)};
  tangent_frame(shape.normal, shape.x, shape.y);
  const auto add = [&](const std::vector<int>& loop) {
    PlanarLoop& planar = shape.loops.emplace_back();
    for (const int v : loop) {
      const Vector3d to = at(v) - shape.origin;
      planar.emplace_back(to.dot(shape.x), to.dot(shape.y));
      shape.box.extend(at(v));
    }
  };
  add(facet.boundary);
  for (const auto& hole : facet.holes) add(hole);
  return shape;
}

Vector3d NearestSurface::nearest_of(const Shape& shape, const Vector3d& from) {
  if (shape.round) return nearest_on(*shape.round, from);
  const Vector3d to = from - shape.origin;
  const Vector2d p(to.dot(shape.x), to.dot(shape.y));
  bool is_inside = false;
  Vector2d best = p;
  double least = std::numeric_limits<double>::infinity();
  for (const PlanarLoop& loop : shape.loops) {
    for (std::size_t i = 0; i < loop.size(); ++i) {
      const Vector2d &a = loop[i], &b = loop[i + 1 < loop.size() ? i + 1 : 0];
      if (crosses_ray(a, b, p)) is_inside = !is_inside;
      const Vector2d near = nearest_on_segment(a, b, p);
      const double distance2 = (near - p).squaredNorm();
      if (distance2 < least) {
        least = distance2;
        best = near;
      }
    }
  }
  if (is_inside) best = p;
  return shape.origin + best.x() * shape.x + best.y() * shape.y;
}

std::optional<Vector3d> NearestSurface::find(const Vector3d& from, double within) const {
  if (!tree_) return std::nullopt;
  std::optional<Vector3d> nearest;
  double least = within * within;
  int number = -1;  // of equally near shapes, the first counts in whatever order they are visited
  tree_->visit_near(from, least, [&](int i) {
    const Vector3d at = nearest_of(shapes_[static_cast<std::size_t>(i)], from);
    const double distance2 = (at - from).squaredNorm();
    if (distance2 < least || (nearest && distance2 == least && i < number)) {
      least = distance2;
      number = i;
      nearest = at;
    }
  });
  return nearest;
}

}  // namespace lightwell
