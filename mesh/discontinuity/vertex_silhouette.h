#pragma once

#include <vector>

#include "mesh/discontinuity/wedge.h"

namespace lightwell {

/// The sector of directions from a point p of a facet into the facet: from `from` to `to`,
/// counter-clockwise about the facet's normal.
struct FacetSector {
  Eigen::Vector3d normal;
  Eigen::Vector3d from, to;  ///< unit
  bool is_full = false;      ///< true if p lies inside the facet; the sector is a full turn
};

/// Appends the sectors of `plane` at p; none if p is farther than `tolerance` (metres) from the
/// facet.
void add_sectors(const FacetPlane& plane, const Eigen::Vector3d& p, double tolerance,
                 std::vector<FacetSector>& sectors);

/// Returns the rays of an EV wedge along which the apex is a corner of the silhouette of the facets
/// that meet there, and is not hidden by these facets. `sectors` are the sectors of the facets at
/// the apex. A range's mask holds the sides of the wedge's plane that the sectors hide entirely.
std::vector<WedgeRange> silhouette_ranges(const Wedge& wedge,
                                          const std::vector<FacetSector>& sectors);

}  // namespace lightwell
