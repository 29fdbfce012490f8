#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "mesh/geometry/triangulate.h"

namespace lightwell {

/// Returns points that let triangles grow from a finely divided line to the size of the others
/// (off-centres; Ungor 2004, "Off-centers: a new type of Steiner points"). Without such points a
/// lamp's round foot sends a fan of slivers over the whole floor.
///
/// Each triangle with an angle below 15 degrees gives a point on the perpendicular bisector of its
/// shortest edge, of length s, from which the edge appears at 22 degrees. There is no point
/// - across a line from its edge, or nearer than s/2 or 3/10 of a line's piece to the piece;
/// - nearer than 1.5 s to another point;
/// - for the angle between two lines, which cannot change;
/// - for an edge below `element_size` / 100 (metres), not worth the elements.
///
/// One round: `lines` are the constraints of `triangulation`, and `inside` marks the triangles that
/// count. At most `most` points are returned, those of the shortest edges first.
std::vector<Eigen::Vector2d> graded_points(const PlanarTriangulation& triangulation,
                                           const std::vector<char>& inside,
                                           const std::vector<std::array<int, 2>>& lines,
                                           double element_size, std::size_t most);

}  // namespace lightwell
