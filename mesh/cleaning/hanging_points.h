#pragma once

#include <vector>

#include "mesh/cleaning/facet_loops.h"

namespace lightwell {

/// The facets with the points of others put into the edges they lie inside of, in order along the
/// edge: where facets met along parts of edges they then meet along whole ones. A point lies inside
/// an edge that it is at most `tolerance` (metres, and 1/1000 of the edge's length) away from and
/// farther from its ends; points of a facet that has the edge stay out. Edges of which the other
/// side is all there, and points at which every facet has its neighbours, are not compared.
/// `hanging` gets how many points were put in (once an edge). Edges along which more points lie
/// than can be looked at in time proportional to the number of edges stay whole.
FacetLoops with_hanging_points(const FacetLoops& facets, const std::vector<Eigen::Vector3d>& points,
                               double tolerance, std::int64_t& hanging);

}  // namespace lightwell
