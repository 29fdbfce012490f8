#pragma once

#include <optional>
#include <span>
#include <vector>

#include "mesh/cleaning/facet_loops.h"

namespace lightwell {

/// A directed edge of a region's boundary, the region on its left.
struct RegionEdge {
  int from = 0, to = 0;  ///< points
};

/// Returns the loops that the edges make: first the boundary, counter-clockwise about `normal`,
/// then the holes, clockwise. A loop passes each point once; loops may touch. Returns nothing if
/// the edges do not close, make more than one counter-clockwise loop, or cross, because they then
/// bound no polygon with holes.
std::optional<std::vector<std::vector<int>>> region_loops(
    std::vector<RegionEdge> edges, const std::vector<Eigen::Vector3d>& points,
    const Eigen::Vector3d& normal);

/// True if any two edges of the loops, projected along `normal`, share more than a common end.
bool do_loops_cross(const std::vector<std::span<const int>>& loops,
                    const std::vector<Eigen::Vector3d>& points, const Eigen::Vector3d& normal);

}  // namespace lightwell
