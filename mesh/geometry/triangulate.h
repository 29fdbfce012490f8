#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

namespace lightwell {

/// Triangles over points of a plane, counter-clockwise.
struct PlanarTriangulation {
  /// The given points, then points added where constraints cross.
  std::vector<Eigen::Vector2d> points{};
  std::vector<std::array<int, 3>> triangles{};
  /// Triangle across the edge opposite corner i; -1 on the convex hull.
  std::vector<std::array<int, 3>> neighbor{};
  /// True where the edge opposite corner i is a constraint or part of one.
  std::vector<std::array<bool, 3>> constrained{};
  /// True if no point was added and no two points were joined: every constraint is one edge.
  bool is_as_given = true;
};

/// The constrained Delaunay triangulation of the convex hull of `points` that has every constraint
/// (a pair of point numbers) as an edge. Predicates are exact (CGAL or CDT). Equal points become
/// one.
///
/// Equal input gives equal triangles: cocircular points are joined as a fan from the
/// lowest-numbered one, and triangles are sorted by their corners.
PlanarTriangulation triangulate(const std::vector<Eigen::Vector2d>& points,
                                const std::vector<std::array<int, 2>>& constraints);

}  // namespace lightwell
