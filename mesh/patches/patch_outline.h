#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "mesh/patches/patch_mesh.h"

namespace lightwell {

/// The polygon that a patch's elements tile.
struct PatchOutline {
  /// Boundary and holes, counter-clockwise and clockwise seen from the side the patch faces,
  /// without vertices inside straight edges. Empty for patches that are not flat or have holes
  /// that a picture cuts.
  std::vector<std::vector<Eigen::Vector3d>> loops{};
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();  ///< unit, towards the side the patch faces
  Eigen::Vector3d center = Eigen::Vector3d::Zero();  ///< mean of the vertices
  double radius = 0.0;                               ///< about `center`, holds all vertices

  bool is_polygon() const { return !loops.empty(); }
};

/// Of one's own loops; the normal is the one about which the first runs counter-clockwise.
PatchOutline polygon_outline(std::vector<std::vector<Eigen::Vector3d>> loops);

/// Of a patch, which may be in pieces: the normal and centre are then those of its first.
PatchOutline patch_outline(const PatchMesh& mesh, int patch);
/// Of all patches.
std::vector<PatchOutline> patch_outlines(const PatchMesh& mesh);

/// The outline of any elements of one plane that face one way, without vertices inside straight
/// edges: edges that two of them share cancel, in whatever patch or facet they are.
std::vector<std::vector<Eigen::Vector3d>> boundary_loops(const PatchMesh& mesh,
                                                         std::span<const int> elements);

}  // namespace lightwell
