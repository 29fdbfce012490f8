#pragma once

#include <array>
#include <vector>

#include "mesh/geometry/facet_plane.h"

namespace lightwell {

/// An emitting polygon: all facets of one material in one plane that are connected over shared
/// edges.
struct EmittingPolygon {
  struct Corner {
    Eigen::Vector3d position;
    std::vector<Eigen::Vector3d> edges{};  ///< unit directions of the border's edges from here
  };
  std::vector<int> planes{};      ///< indices into the planes, ascending
  Eigen::Vector3d normal;         ///< unit, towards the side that is lit
  Eigen::Vector3d center;         ///< mean of the facets' origins, weighted by area
  double area = 0.0;              ///< m^2
  double power = 0.0;             ///< W that one side emits, mean over the bands
  std::vector<Corner> corners{};  ///< points at which the border turns
  std::vector<std::array<Eigen::Vector3d, 2>> edges{};  ///< end points of the border's edges
};

/// Returns all emitting sides of a scene by falling power; an emitter of two sides gives two
/// polygons.
std::vector<EmittingPolygon> emitting_polygons(const Scene& scene,
                                               const std::vector<FacetPlane>& planes);

/// An edge that may cast a shadow, because facets end or bend there.
struct OccluderEdge {
  int a = 0, b = 0;           ///< points, a < b
  Eigen::Vector3d from, to;   ///< their positions
  std::vector<int> planes{};  ///< facets that have the edge, as indices into the planes
  std::vector<Eigen::Vector3d> inwards{};  ///< unit, from the edge into each of the facets
};

/// A point at which occluder edges meet.
struct OccluderVertex {
  Eigen::Vector3d position;
  std::vector<Eigen::Vector3d> edges{};  ///< unit directions of its OccluderEdges
};

struct OccluderFeatures {
  std::vector<OccluderEdge> edges{};
  std::vector<OccluderVertex> vertices{};
};

/// Returns the edges and vertices of all facets except clear ones, which light passes. Left out are
/// edges between two facets that continue each other in one plane, and vertices in the middle of a
/// straight edge.
OccluderFeatures occluder_features(const Scene& scene, const std::vector<FacetPlane>& planes);

}  // namespace lightwell
