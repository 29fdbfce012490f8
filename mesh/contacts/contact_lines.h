#pragma once

#include <array>
#include <vector>

#include "mesh/geometry/facet_plane.h"
#include "scene/round_shape.h"

namespace lightwell {

/// A straight piece of a line along which two surfaces touch or cross.
using ContactSegment = std::array<Eigen::Vector3d, 2>;

/// Returns the segments in which two facets meet:
/// - for crossing facets, the part of the line of both planes inside both polygons;
/// - for a facet that stands on another, its edge;
/// - for facets in one plane, the parts of either boundary that lie on the other facet.
///
/// Points within `tolerance` (metres) of a plane or an edge count as on it. Facets that touch in
/// single points give nothing, and neither do two triangles that share an edge without overlapping.
std::vector<ContactSegment> facet_contact(const FacetPlane& a, const FacetPlane& b,
                                          double tolerance);

/// Returns the curve in which a round shape cuts or touches a facet, inside the polygon, as chords
/// of arcs no longer than `max_arc` (metres). A circle of a radius up to `min_radius` (metres)
/// gives nothing; neither does a frustum that is nowhere wider, or a sphere that only touches.
std::vector<ContactSegment> round_contact(const FacetPlane& plane, const RoundShape& shape,
                                          double max_arc, double min_radius, double tolerance);

}  // namespace lightwell
