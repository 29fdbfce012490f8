#include "scene/io/flat_loop.h"

#include <Eigen/Geometry>
#include <cmath>

#include "scene/sampling.h"

namespace lightwell {

Eigen::Vector3d mean_point(const Loop& loop) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  // Relative to loop[0]: keeps digits far from the origin.
  for (const auto& p : loop) sum += p - loop[0];
  return loop[0] + sum / static_cast<double>(loop.size());
}

bool has_area(double area, const Loop& loop) {
  const double size = size_of(loop);
  return area > 0.5 * flatness * size * size;
}

LoopPlane::LoopPlane(const Loop& boundary) : size(size_of(boundary)) {
  origin = mean_point(boundary);
  const Eigen::Vector3d area = area_vector(boundary);
  normal = area.norm() > 0.0 ? Eigen::Vector3d(area.normalized()) : Eigen::Vector3d::UnitZ();
  tangent_frame(normal, x, y);
}

FlatLoop LoopPlane::flatten(const Loop& loop) const {
  FlatLoop flat;
  for (const auto& p : loop) {
    flat.emplace_back((p - origin).dot(x) / size, (p - origin).dot(y) / size);
  }
  return flat;
}

double orientation(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& c) {
  const Eigen::Vector2d ab = b - a, ac = c - a;
  const double area = ab.x() * ac.y() - ab.y() * ac.x();
  return std::abs(area) > coincidence * ab.norm() ? area : 0.0;
}

bool cross_properly(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& c,
                    const Eigen::Vector2d& d) {
  return orientation(a, b, c) * orientation(a, b, d) < 0.0 &&
         orientation(c, d, a) * orientation(c, d, b) < 0.0;
}

bool are_apart(const LoopTree::Box& box, const LoopTree::Box& other) {
  return (box.max().array() < other.min().array() - coincidence).any() ||
         (other.max().array() < box.min().array() - coincidence).any();
}

LoopTree::Box box_of_edge(const FlatLoop& p, std::size_t i) {
  return LoopTree::Box(p[i]).extend(p[(i + 1) % p.size()]);
}

LoopTree tree_of_edges(const FlatLoop& p) {
  return {p.size(), [&](std::size_t i) { return box_of_edge(p, i); }};
}

LoopTree tree_of_corners(const FlatLoop& p) {
  return {p.size(), [&](std::size_t i) { return LoopTree::Box(p[i]); }};
}

}  // namespace lightwell
