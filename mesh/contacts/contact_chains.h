#pragma once

#include "mesh/contacts/contact_graph.h"

namespace lightwell {

/// Returns the outline with finely divided contact lines joined into longer pieces (Douglas &
/// Peucker 1973). Where a surface of many small facets crosses a large one, as a cushion crosses
/// the wall behind it, the short pieces would otherwise make slivers of the wall.
///
/// A point is a candidate for removal if two pieces of contact lines meet there and nothing else,
/// both shorter than `element_size` / 10 (metres). The joined line stays within `element_size` /
/// 200 of the original, and no joined piece is longer than `element_size` / 2. Boundary and creases
/// stay. The outline's numbers are indices into `points`.
FacetOutline with_joined_contacts(const FacetOutline& outline,
                                  const std::vector<Eigen::Vector3d>& points, double element_size);

}  // namespace lightwell
