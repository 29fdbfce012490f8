#pragma once

#include <array>
#include <vector>

#include "mesh/geometry/facet_plane.h"

namespace lightwell {

/// A straight piece of a line along which two surfaces touch or cross.
using ContactSegment = std::array<Eigen::Vector3d, 2>;

/// Where two facets meet: the intersection of two crossing planes inside both polygons; the edge of
/// one that stands on the other; for facets in one plane, the parts of either's boundary that lie
/// on the other. Points within `tolerance` (metres) of a plane or an edge count as on it. Touching
/// in a point gives nothing.
std::vector<ContactSegment> facet_contact(const FacetPlane& a, const FacetPlane& b,
                                          double tolerance);

/// The circle in which a sphere cuts a facet, inside the polygon, as chords of arcs no longer than
/// `max_arc` (metres). A circle smaller than `min_radius` gives nothing.
std::vector<ContactSegment> sphere_contact(const FacetPlane& plane, const Sphere& sphere,
                                           double max_arc, double min_radius, double tolerance);

}  // namespace lightwell
