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

/// From point `v` through the edge p-q; its plane is meaningless where v lies on the edge's line.
Wedge vertex_edge_wedge(const Eigen::Vector3d& v, const Eigen::Vector3d& p,
                        const Eigen::Vector3d& q);
/// From the edge a-b through point `p`.
Wedge edge_vertex_wedge(const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                        const Eigen::Vector3d& p);

/// Which sides of a wedge's plane something hides along its rays: the side its normal points to,
/// the other, or both. What hides both ends the wedge.
enum SideMask : unsigned { hides_nothing = 0, hides_front = 1, hides_back = 2, hides_both = 3 };

/// A range of rays, and what the occluder's own faces hide along them.
struct WedgeRange {
  double begin = 0.0, end = 1.0;
  unsigned mask = hides_nothing;
};

/// A straight piece of a critical line on a facet.
struct WedgeTrace {
  int facet = 0;  ///< index into the planes
  double begin = 0.0, end = 0.0;
  Eigen::Vector3d from, to;
  bool is_contact = false;  ///< the occluder's edge itself, which lies in the facet
};

/// Follows a wedge through the facets `near` (indices into `planes`): 2-D visibility in its plane.
/// Along every ray, what hides one side of the plane is passed and what hides both is where the
/// line falls, unless that stands before the occluder. Facets in the wedge's plane hide nothing.
/// Corners within `tolerance` (metres) of the plane lie in it. `ranges` are the rays to follow.
std::vector<WedgeTrace> trace_wedge(const Wedge& wedge, const std::vector<WedgeRange>& ranges,
                                    const std::vector<FacetPlane>& planes,
                                    const std::vector<int>& near, double tolerance);

}  // namespace lightwell
