#pragma once

#include <Eigen/Core>
#include <vector>

#include "mesh/patches/patch_mesh.h"

namespace lightwell {

/// build_topology() for vertices that all exist, which gives an element that does not fit its
/// neighbours vertices of its own, behind the others, instead of throwing: light is not continuous
/// there. Throws std::runtime_error for an element that repeats a corner.
void build_parted_topology(PatchMesh& mesh, const std::vector<Eigen::Vector3d>& positions);

}  // namespace lightwell
