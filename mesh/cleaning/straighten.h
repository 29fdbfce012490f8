#pragma once

#include <vector>

#include "mesh/cleaning/facet_loops.h"

namespace lightwell {

/// Takes vertices inside straight edges out of the facets marked in `may_change`, where the facets
/// on both sides of the edge are marked and go straight on alike (Douglas & Peucker 1973). What
/// lies within `tolerance` (metres, and 1/1000 of the edge's length) of an edge is straight. Facets
/// whose boundary would then touch or cross itself keep their vertices.
void straighten(FacetLoops& facets, const std::vector<char>& may_change,
                const std::vector<Eigen::Vector3d>& points, double tolerance);

}  // namespace lightwell
