#pragma once

#include "mesh/contacts/contact_graph.h"

namespace lightwell {

/// The outline with contact lines in fewer pieces, where what crosses the facet is divided more
/// finely than its elements: a cushion's thousand facets would make slivers of the wall behind it.
/// A point in which two pieces of contact lines meet, both below 1/10 of `element_size` (metres),
/// and nothing else, goes where the line stays within 1/200 of it of what it was and no piece
/// becomes longer than half of it (Douglas & Peucker 1973). The boundary stays.
FacetOutline with_joined_contacts(const FacetOutline& outline,
                                  const std::vector<Eigen::Vector3d>& points, double element_size);

}  // namespace lightwell
