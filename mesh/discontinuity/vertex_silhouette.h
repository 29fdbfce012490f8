#pragma once

#include <vector>

#include "mesh/discontinuity/wedge.h"

namespace lightwell {

/// What a facet leaves at a point p of its own, seen from p: the sector between two directions of
/// its plane, counter-clockwise about its normal.
struct FacetSector {
  Eigen::Vector3d normal;
  Eigen::Vector3d from, to;  ///< unit
  bool is_full = false;      ///< p lies inside the facet
};

/// The sectors of `plane` at p; none if p is not within `tolerance` of the facet.
void add_sectors(const FacetPlane& plane, const Eigen::Vector3d& p, double tolerance,
                 std::vector<FacetSector>& sectors);

/// The rays of an EV wedge along which its apex is a corner of the outline of what stands there,
/// given by its sectors, and not hidden by it. The mask tells which halves about the wedge's plane
/// the sectors hide entirely.
std::vector<WedgeRange> silhouette_ranges(const Wedge& wedge,
                                          const std::vector<FacetSector>& sectors);

}  // namespace lightwell
