#pragma once

#include <Eigen/Core>
#include <array>
#include <cassert>
#include <span>
#include <vector>

namespace lightwell {

/// Points p with height(p) = normal . p - offset >= 0. The normal need not have unit length.
struct HalfSpace {
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();
  double offset = 0.0;
  double height(const Eigen::Vector3d& p) const { return normal.dot(p) - offset; }
  HalfSpace opposite() const { return {-normal, -offset}; }
};

/// True if every point has at most (all_below) or at least (all_above) the given height over the
/// plane; any_above and any_below are their negations.
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

/// Planar convex polygon of at most 24 corners. The corners lie in the object itself, so clipping
/// allocates no memory.
struct ConvexPolygon {
  static constexpr int most_corners = 24;
  std::array<Eigen::Vector3d, most_corners> corner;
  int count = 0;

  ConvexPolygon() = default;
  /// Precondition: at most most_corners corners.
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

/// Result of split().
enum class Cut { none_inside, all_inside, both };

/// Splits the polygon at the plane height(p) = 0. `inside` and `outside` are filled only for
/// Cut::both. A part thinner than 1e-12 of the other part's depth counts as empty. Precondition:
/// count < most_corners.
Cut split(const ConvexPolygon& polygon, const HalfSpace& half_space, ConvexPolygon& inside,
          ConvexPolygon& outside);

/// Clips the polygon to the half-space. Returns false if no part of the polygon lies inside.
bool clip(ConvexPolygon& polygon, const HalfSpace& half_space);

/// Convex polygons of at most 12 corners that tile a polygon with holes: a constrained Delaunay
/// triangulation whose inner edges are removed, longest first, as long as the joined pieces stay
/// convex (Hertel & Mehlhorn 1983). Counter-clockwise about `normal`. Empty if the loops cross each
/// other.
std::vector<ConvexPolygon> convex_pieces(const std::vector<std::vector<Eigen::Vector3d>>& loops,
                                         const Eigen::Vector3d& normal);

/// Convex hull of coplanar points, counter-clockwise about `normal`, to 1e-9 of its size. Empty if
/// the points have no area, or if more than 16 of them are corners of the hull.
ConvexPolygon convex_hull(std::span<const Eigen::Vector3d> points, const Eigen::Vector3d& normal);

}  // namespace lightwell
