#pragma once

#include <vector>

#include "mesh/cleaning/facet_loops.h"

namespace lightwell {

/// Regions of facets of one surface that lie in one plane and are connected over whole edges.
struct PlaneRegions {
  /// Per facet, its region; -1: the facet could be joined with no other.
  std::vector<int> region{};
  /// Per region, its boundary, then its holes; empty if the region cannot be one polygon.
  std::vector<std::vector<std::vector<int>>> outlines{};

  bool is_merged(int facet) const { return region[facet] >= 0 && !outlines[region[facet]].empty(); }
};

/// Grows regions from the largest facets on. A facet joins over an edge if
/// - exactly one facet of the region's plane meets the region there;
/// - all its corners lie within `tolerance` (metres) of the plane fitted to the region;
/// - its normal is within 1 degree of the plane's, or it is a needle so thin that the tolerance may
///   tilt it more.
///
/// If the fitted plane turns so far that earlier facets no longer lie in it, the region is grown
/// again in the plane of its largest facet. So the area of a region differs from its facets' by
/// less than the tolerance times the length of their edges.
PlaneRegions find_plane_regions(const FacetLoops& facets,
                                const std::vector<Eigen::Vector3d>& points, double tolerance);

}  // namespace lightwell
