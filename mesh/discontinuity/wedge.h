#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "mesh/geometry/facet_plane.h"

namespace lightwell {

/// A critical surface of vertex and edge: the rays from a point of an emitter through an edge of an
/// occluder (VE), or from an edge of an emitter through a point of an occluder (EV). All rays meet
/// in the apex; ray s in [0, 1] is apex + alpha (along + s across). alpha is 0 on the emitter and 1
/// on the occluder for VE, -1 and 0 for EV.
struct Wedge {
  Eigen::Vector3d apex, along, across;
  Eigen::Vector3d normal;  ///< unit, of the wedge's plane
  bool is_vertex_edge = true;

  Eigen::Vector3d direction(double s) const { return along + s * across; }
  Eigen::Vector3d at(double s, double alpha) const { return apex + alpha * direction(s); }
};

/// The VE wedge from the point `v` through the edge p-q. The normal is meaningless if v lies on the
/// line of the edge.
Wedge vertex_edge_wedge(const Eigen::Vector3d& v, const Eigen::Vector3d& p,
                        const Eigen::Vector3d& q);
/// The EV wedge from the edge a-b through the point `p`.
Wedge edge_vertex_wedge(const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                        const Eigen::Vector3d& p);

/// Bits for the sides of a wedge's plane that an occluder hides along the rays: the front (the side
/// that `Wedge::normal` points to), the back, or both. An occluder that hides both sides ends the
/// wedge.
enum SideMask : unsigned { hides_nothing = 0, hides_front = 1, hides_back = 2, hides_both = 3 };

/// A range of rays, with the SideMask of what the occluder's own faces hide along the range.
struct WedgeRange {
  double begin = 0.0, end = 1.0;
  unsigned mask = hides_nothing;
};

/// A straight piece of a critical line on a facet.
struct WedgeTrace {
  int facet = 0;                  ///< index into the planes
  double begin = 0.0, end = 0.0;  ///< rays
  Eigen::Vector3d from, to;
  bool is_contact = false;  ///< true if the piece is the occluder's edge itself, lying in the facet
};

/// Traces the rays `ranges` of a wedge through the facets `near` (indices into `planes`), by 2-D
/// visibility in the wedge's plane. Along each ray, facets that hide one side of the plane are
/// passed, and the first facet that hides both sides carries the critical line. There is no line
/// where both sides were hidden before that facet, or where a facet between emitter and occluder
/// hides them.
///
/// Facets in the wedge's plane hide nothing. Corners within `tolerance` (metres) of the plane count
/// as in the plane.
std::vector<WedgeTrace> trace_wedge(const Wedge& wedge, const std::vector<WedgeRange>& ranges,
                                    const std::vector<FacetPlane>& planes,
                                    const std::vector<int>& near, double tolerance);

}  // namespace lightwell
