#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

namespace lightwell {

/// Joins pairs of triangles into well-shaped convex quadrilaterals, best first (Borouchaki & Frey
/// 1998 survey the idea). `xy` are the vertices; neighbor[t][i] is the triangle across the edge
/// opposite corner i that t may be joined with, or -1. Returns for each triangle its partner, or
/// -1.
std::vector<int> pair_triangles(const std::vector<Eigen::Vector2d>& xy,
                                const std::vector<std::array<int, 3>>& triangles,
                                const std::vector<std::array<int, 3>>& neighbor);

/// The corners, counter-clockwise, of the quadrilateral of triangle t and its neighbour `other`
/// across the edge opposite `opposite_corner`.
std::array<int, 4> joined_corners(const std::array<int, 3>& t, const std::array<int, 3>& other,
                                  int opposite_corner);

}  // namespace lightwell
