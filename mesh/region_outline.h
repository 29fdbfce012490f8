#pragma once

#include <optional>
#include <vector>

#include "mesh/facet_loops.h"

namespace lightwell {

/// A directed edge of a region's boundary, the region on its left.
struct RegionEdge {
  int from = 0, to = 0;  ///< points
};

/// The loops that edges make: the one boundary first, counter-clockwise about `normal`, then the
/// holes, clockwise. A loop passes each point once; loops may touch. Nothing if the edges do not
/// close, make more than one counter-clockwise loop, or cross: then they bound no polygon with
/// holes.
std::optional<std::vector<std::vector<int>>> region_loops(
    std::vector<RegionEdge> edges, const std::vector<Eigen::Vector3d>& points,
    const Eigen::Vector3d& normal);

/// Takes vertices inside straight edges out of the facets marked in `may_change`, where the facets
/// on both sides of the edge are marked and go straight on alike. What lies within 1e-10 of an
/// edge's length from it is straight.
void straighten(FacetLoops& facets, const std::vector<char>& may_change,
                const std::vector<Eigen::Vector3d>& points);

}  // namespace lightwell
