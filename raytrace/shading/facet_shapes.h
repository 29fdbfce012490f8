#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "mesh/elements/element_caster.h"
#include "mesh/patches/patch_mesh.h"
#include "scene/facet_normals.h"
#include "scene/round_shape.h"
#include "scene/scene.h"

namespace lightwell {

/// Geometry and material of a facet.
struct FacetShape {
  int material = 0;
  int smooth_surface = 0;   ///< the same for facets that share vertices
  int round = -1;           ///< number of FacetShapes::round(); -1: a polygon
  std::uint64_t chain = 0;  ///< the same for facets of one plane or of one curved surface
  Eigen::Vector3d point = Eigen::Vector3d::Zero();  ///< on the plane
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();
};

/// The shapes of all facets of a scene.
class FacetShapes {
 public:
  /// `mesh` and `normals` are of the scene.
  FacetShapes(const Scene& scene, const PatchMesh& mesh, const FacetNormals& normals);

  const FacetShape& operator[](int facet) const { return facets_[static_cast<std::size_t>(facet)]; }
  /// The round shape of a facet that is no polygon.
  const RoundShape& round(const FacetShape& facet) const {
    return round_[static_cast<std::size_t>(facet.round)];
  }
  /// The geometric normal at a point of a facet, unit, against a direction; all in the rest pose.
  Eigen::Vector3d normal_against(const Eigen::Vector3d& direction, int facet,
                                 const Eigen::Vector3d& point) const;
  /// The shading normal at a hit, unit, on the side of the geometric `normal`; all in the rest
  /// pose: that of a round shape, the file's (`normals`), or that of the mesh's vertices, which
  /// rounds off a tessellated surface and equals the facet's on a flat one. Precondition: the hit
  /// has an element.
  Eigen::Vector3d smooth_normal(const PatchMesh& mesh, const FacetNormals& normals,
                                const ElementHit& hit, const Eigen::Vector3d& point,
                                const Eigen::Vector3d& normal) const;

 private:
  std::vector<FacetShape> facets_{};
  std::vector<RoundShape> round_{};
};

}  // namespace lightwell
