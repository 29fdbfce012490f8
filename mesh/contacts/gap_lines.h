#pragma once

#include <vector>

#include "mesh/contacts/contact_lines.h"
#include "mesh/geometry/facet_plane.h"

namespace lightwell {

/// Limits of gap_lines(), metres.
struct GapLimits {
  double narrowest = 0.0;     ///< closer surfaces touch
  double widest = 0.0;        ///< light varies over about this length where a wider gap begins
  double least_width = 0.0;   ///< mean width (2 area / boundary) of the narrowest facet that counts
  double least_length = 0.0;  ///< half of the boundary of the shortest narrower strip that counts
  double touching = 0.0;      ///< surfaces up to this apart lie on each other for rays
};

/// Width of the widest gap that a facet covers, metres: `limits.widest` if the facet is
/// `least_width` wide; a third of the mean width of a narrower strip of `least_length`, such as the
/// lower edge of a door, below which more light would pass across the gap than stay in it; else 0.
/// At least `limits.touching`: rays take the gap for none, and the facet hides what is below.
double widest_covered(const FacetPlane& facet, const GapLimits& limits);

/// The outline of `over` above `on`, projected along the normal of `on`, inside `on`: the lines
/// where a narrow gap between both facets begins, such as that between a desk and the foot of a
/// monitor. Light falls off within about the width of the gap behind such a line, so to elements
/// that are much larger the line is a discontinuity like a contact line.
///
/// Left out are edges nowhere farther than `narrowest`, parts of the outline farther than
/// widest_covered() of `over`, facets that do not face each other (within 60 degrees), and lines
/// along the boundary of `on`, nearer than twice their distance from `over`.
std::vector<ContactSegment> gap_lines(const FacetPlane& on, const FacetPlane& over,
                                      const GapLimits& limits);

}  // namespace lightwell
