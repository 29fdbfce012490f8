#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "mesh/patches/patch_mesh.h"

namespace lightwell {

/// The polygon that a patch's elements tile.
struct PatchOutline {
  /// Boundary and holes, metres: counter-clockwise and clockwise seen from the side that the patch
  /// faces, without vertices inside straight edges. Empty for patches that are not flat or have
  /// holes cut by a picture.
  std::vector<std::vector<Eigen::Vector3d>> loops{};
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();  ///< unit, towards the side the patch faces
  Eigen::Vector3d center = Eigen::Vector3d::Zero();  ///< mean of the vertices
  double radius = 0.0;  ///< largest distance of a vertex from `center`, metres

  bool is_polygon() const { return !loops.empty(); }
};

/// The outline of given loops. The normal is the one about which the first loop runs
/// counter-clockwise.
PatchOutline polygon_outline(std::vector<std::vector<Eigen::Vector3d>> loops);

/// The outline of a patch. If the patch is in pieces, normal and centre are those of its first
/// piece.
PatchOutline patch_outline(const PatchMesh& mesh, int patch);
/// The outlines of all patches.
std::vector<PatchOutline> patch_outlines(const PatchMesh& mesh);

/// The outline of elements of one plane that face one way, without vertices inside straight edges.
/// Edges shared by two of the elements cancel, in whatever patch or facet the elements are.
std::vector<std::vector<Eigen::Vector3d>> boundary_loops(const PatchMesh& mesh,
                                                         std::span<const int> elements);

}  // namespace lightwell
