#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

namespace lightwell {

/// Triangles over points of a plane, counter-clockwise.
struct PlanarTriangulation {
  std::vector<Eigen::Vector2d> points{};  ///< those given, then any added where constraints cross
  std::vector<std::array<int, 3>> triangles{};
  /// Triangle across the edge opposite corner i; -1 on the convex hull.
  std::vector<std::array<int, 3>> neighbor{};
  /// Whether the edge opposite corner i is (part of) a constraint.
  std::vector<std::array<bool, 3>> constrained{};
  /// No point was added or joined with an equal one: every constraint is an edge as it was given.
  bool is_as_given = true;
};

/// Constrained Delaunay triangulation of the convex hull of `points` that has every constraint (a
/// pair of point numbers) as an edge; predicates are exact (CGAL). Equal points become one. Of
/// points on one circle the lowest is joined with all others, and triangles are in the order of
/// their corners, so that the same input gives the same triangles.
PlanarTriangulation triangulate(const std::vector<Eigen::Vector2d>& points,
                                const std::vector<std::array<int, 2>>& constraints);

}  // namespace lightwell
