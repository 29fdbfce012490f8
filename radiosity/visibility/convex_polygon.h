#pragma once

#include <Eigen/Core>
#include <array>
#include <cassert>
#include <span>
#include <vector>

namespace lightwell {

/// The points p with height(p) >= 0.
struct HalfSpace {
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();
  double offset = 0.0;
  double height(const Eigen::Vector3d& p) const { return normal.dot(p) - offset; }
  HalfSpace opposite() const { return {-normal, -offset}; }
};

/// Whether all points are at most, or at least, this high; any of them higher, or lower.
bool all_below(std::span<const Eigen::Vector3d> points, const HalfSpace& plane, double height);
bool all_above(std::span<const Eigen::Vector3d> points, const HalfSpace& plane, double height);
inline bool any_above(std::span<const Eigen::Vector3d> points, const HalfSpace& plane,
                      double height) {
  return !all_below(points, plane, height);
}
inline bool any_below(std::span<const Eigen::Vector3d> points, const HalfSpace& plane,
                      double height) {
  return !all_above(points, plane, height);
}

/// A planar convex polygon of few corners that needs no memory of its own, to be cut many times.
struct ConvexPolygon {
  static constexpr int most_corners = 24;
  std::array<Eigen::Vector3d, most_corners> corner;
  int count = 0;

  ConvexPolygon() = default;
  /// Of at most most_corners corners.
  explicit ConvexPolygon(std::span<const Eigen::Vector3d> corners);
  ConvexPolygon(const ConvexPolygon& other) : ConvexPolygon(other.corners()) {}
  ConvexPolygon& operator=(const ConvexPolygon& other);

  void add(const Eigen::Vector3d& v) {
    assert(count < most_corners);
    corner[static_cast<std::size_t>(count++)] = v;
  }
  std::span<const Eigen::Vector3d> corners() const {
    return {corner.data(), static_cast<std::size_t>(count)};
  }
  double area() const;
};

/// What split() did.
enum class Cut { none_inside, all_inside, both };

/// Cuts the polygon by the plane at height 0. Only for `both` are `inside` and `outside` filled;
/// parts thinner than 1e-12 of the other side's depth are none. The polygon must have a corner to
/// spare: count < most_corners.
Cut split(const ConvexPolygon& polygon, const HalfSpace& half_space, ConvexPolygon& inside,
          ConvexPolygon& outside);

/// The part inside; false if there is none.
bool clip(ConvexPolygon& polygon, const HalfSpace& half_space);

/// Convex polygons of at most 12 corners that tile a polygon with holes: a constrained Delaunay
/// triangulation whose inner edges are taken out while what they join is convex (Hertel & Mehlhorn
/// 1983). Counter-clockwise about `normal`. Empty if the loops cross each other.
std::vector<ConvexPolygon> convex_pieces(const std::vector<std::vector<Eigen::Vector3d>>& loops,
                                         const Eigen::Vector3d& normal);

/// Of points in one plane, counter-clockwise about `normal`, to 1e-9 of its size. Empty if they
/// have no area, or if more than 16 of them are corners.
ConvexPolygon convex_hull(std::span<const Eigen::Vector3d> points, const Eigen::Vector3d& normal);

}  // namespace lightwell
