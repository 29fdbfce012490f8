#pragma once

#include <vector>

#include "mesh/cleaning/facet_loops.h"

namespace lightwell {

/// Returns the facets with points of other facets inserted into the edges in which these lie
/// (T-junctions), in order along the edge, so that facets that met along parts of edges meet along
/// whole ones.
/// - A point lies in an edge if its distance is at most `tolerance` (metres) and at most 1/1000 of
///   the edge's length, and its distance from both ends is greater.
/// - Points of a facet that has the edge are not inserted.
/// - Edges of several facets are not compared with points all of whose edges have several facets.
/// - Edges along which more points lie than can be visited in time proportional to the number of
///   edges stay whole.
///
/// `hanging` is set to the number of inserted points, counted once per edge.
FacetLoops with_hanging_points(const FacetLoops& facets, const std::vector<Eigen::Vector3d>& points,
                               double tolerance, std::int64_t& hanging);

}  // namespace lightwell
