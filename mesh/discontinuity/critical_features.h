#pragma once

#include <array>
#include <vector>

#include "mesh/geometry/facet_plane.h"

namespace lightwell {

/// An emitting polygon: facets of one material in one plane that share edges, as far as they do.
struct EmittingPolygon {
  struct Corner {
    Eigen::Vector3d position;
    std::vector<Eigen::Vector3d> edges{};  ///< unit directions of the border from here
  };
  std::vector<int> planes{};                            ///< ascending
  Eigen::Vector3d normal;                               ///< unit, towards the side that is lit
  Eigen::Vector3d center;                               ///< of area
  double area = 0.0;                                    ///< m^2
  double power = 0.0;                                   ///< W, of one side, mean of the bands
  std::vector<Corner> corners{};                        ///< where the border turns
  std::vector<std::array<Eigen::Vector3d, 2>> edges{};  ///< of the border
};

/// All emitting sides of a scene, most powerful first.
std::vector<EmittingPolygon> emitting_polygons(const Scene& scene,
                                               const std::vector<FacetPlane>& planes);

/// An edge that may cast a shadow: facets end or bend there.
struct OccluderEdge {
  int a = 0, b = 0;                        ///< points, a < b
  Eigen::Vector3d from, to;                ///< their positions
  std::vector<int> planes{};               ///< that have this edge
  std::vector<Eigen::Vector3d> inwards{};  ///< from the edge into each of them
};

/// A corner of such edges.
struct OccluderVertex {
  Eigen::Vector3d position;
  std::vector<Eigen::Vector3d> edges{};  ///< unit directions of its OccluderEdges
};

struct OccluderFeatures {
  std::vector<OccluderEdge> edges{};
  std::vector<OccluderVertex> vertices{};
};

/// Of all facets but clear ones (light passes those). Edges between two facets that continue each
/// other in one plane, and vertices without edges or in the middle of a straight one, are left out.
OccluderFeatures occluder_features(const Scene& scene, const std::vector<FacetPlane>& planes);

}  // namespace lightwell
