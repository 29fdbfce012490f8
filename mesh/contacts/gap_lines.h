#pragma once

#include <vector>

#include "mesh/contacts/contact_lines.h"
#include "mesh/geometry/facet_plane.h"

namespace lightwell {

/// Limits of gap_lines(), metres.
struct GapLimits {
  double narrowest = 0.0;    ///< closer surfaces touch
  double widest = 0.0;       ///< light varies over about this length where a wider gap begins
  double least_width = 0.0;  ///< mean width (2 area / boundary) of the narrowest facet that counts
};

/// True if a facet is wide enough to cover a gap.
bool covers_gaps(const FacetPlane& facet, const GapLimits& limits);

/// The outline of `over` above `on`, projected along the normal of `on`, inside `on`: the lines
/// where a narrow gap between both facets begins, such as that between a desk and the foot of a
/// monitor. Light falls off within about the width of the gap behind such a line, so to elements
/// that are much larger the line is a discontinuity like a contact line.
///
/// Left out are parts of the outline nearer than `narrowest` or farther than `widest`, facets that
/// do not face each other (within 60 degrees), facets that are narrower than `least_width`, and
/// lines along the boundary of `on`, nearer than twice their distance from `over`.
std::vector<ContactSegment> gap_lines(const FacetPlane& on, const FacetPlane& over,
                                      const GapLimits& limits);

}  // namespace lightwell
