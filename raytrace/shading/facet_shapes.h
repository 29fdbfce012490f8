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

/// Normal of the mesh's vertices at a hit, unit, in the rest pose, which rounds off a tessellated
/// surface and equals the facet's on a flat one; `otherwise` where they cancel. Precondition: the
/// hit has an element, which is no round shape's.
Eigen::Vector3d mesh_normal(const PatchMesh& mesh, const ElementHit& hit,
                            const Eigen::Vector3d& otherwise);

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

 private:
  std::vector<FacetShape> facets_{};
  std::vector<RoundShape> round_{};
};

}  // namespace lightwell
