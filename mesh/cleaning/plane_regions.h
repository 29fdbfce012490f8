#pragma once

#include <vector>

#include "mesh/cleaning/facet_loops.h"

namespace lightwell {

/// Facets of one surface that lie in one plane and hang together over whole edges.
struct PlaneRegions {
  std::vector<int> region{};  ///< by facet; -1 where nothing could be added to a facet
  /// By region: its boundary, then its holes; empty if it cannot be one polygon.
  std::vector<std::vector<std::vector<int>>> outlines{};

  bool is_merged(int facet) const { return region[facet] >= 0 && !outlines[region[facet]].empty(); }
};

/// Grows regions from the largest facets on. A facet joins where exactly one of the region's meets
/// it at an edge, all its corners lie within `tolerance` (metres) of the plane that fits the
/// region, and it faces as that does to 1 degree, or is a needle no wider than what the tolerance
/// may do to it; where the plane turns away from the first of the facets so, theirs is that of the
/// largest. So a region's area differs from its facets' by less than the tolerance times the length
/// of their edges.
PlaneRegions find_plane_regions(const FacetLoops& facets,
                                const std::vector<Eigen::Vector3d>& points, double tolerance);

}  // namespace lightwell
