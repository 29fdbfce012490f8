#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "mesh/geometry/triangulate.h"

namespace lightwell {

/// Points that let triangles grow from a finely divided line to the size of the others: without
/// them a lamp's round foot sends a fan of slivers over the whole floor. Each stands off the
/// shortest edge, of length s, of a triangle with an angle below 15 degrees, where with it that
/// angle would be 22 (off-centres; Ungor 2004, "Off-centers: a new type of Steiner points"), unless
/// a line lies in between or nearer than s/2 or 3/10 of its piece; none comes nearer than 1.5 s to
/// another. Angles between two lines are what they are, and edges below 1/100 of `element_size`
/// are not worth the elements. One round: `lines` are the constraints of `triangulation`, `inside`
/// says which triangles count. At most `most` points, those of the shortest edges first.
std::vector<Eigen::Vector2d> graded_points(const PlanarTriangulation& triangulation,
                                           const std::vector<char>& inside,
                                           const std::vector<std::array<int, 2>>& lines,
                                           double element_size, std::size_t most);

}  // namespace lightwell
