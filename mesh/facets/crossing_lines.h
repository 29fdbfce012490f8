#pragma once

#include "mesh/geometry/triangulate.h"

namespace lightwell {

/// Triangulates as triangulate() does, without slivers where lines cross. Lines through one place
/// cross in pairs, at points that rounding sets apart, and a line misses the point on it by as
/// little. So points where lines cross are one with points up to `rounding` away, and lines pass
/// through points up to `rounding` away, as in snap rounding (Hobby 1999, "Practical segment
/// intersection with finite precision output"). `points` all stay, with their numbers.
PlanarTriangulation triangulate_crossing(const std::vector<Eigen::Vector2d>& points,
                                         const std::vector<std::array<int, 2>>& constraints,
                                         double rounding);

/// The corner of a triangle that is opposite its longest edge, if it lies at most `rounding` from
/// the line of that edge; else -1.
int flat_corner(const PlanarTriangulation& triangulation, int triangle, double rounding);

}  // namespace lightwell
