#pragma once

#include <vector>

#include "mesh/cleaning/facet_loops.h"

namespace lightwell {

/// Removes vertices inside straight edges of the facets marked in `may_change` (Douglas & Peucker
/// 1973). A vertex may go if the facets on both sides of the edge are marked and have the same
/// neighbours of the vertex. Points within `tolerance` (metres) of an edge, and within 1/1000 of
/// the edge's length, count as on the edge. Facets whose boundary would then touch or cross itself
/// keep their vertices.
void straighten(FacetLoops& facets, const std::vector<char>& may_change,
                const std::vector<Eigen::Vector3d>& points, double tolerance);

}  // namespace lightwell
