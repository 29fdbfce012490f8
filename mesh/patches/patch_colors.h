#pragma once

#include <vector>

#include "mesh/patches/patch_mesh.h"

namespace lightwell {

/// Returns for each patch a small number >= 0 that no neighbour has, so that patches coloured by
/// the number can be distinguished. Neighbours share an edge of an element, also across facets and
/// surfaces; end points within 1e-9 of the mesh's extent are equal. The colouring is greedy, by
/// falling number of neighbours (Welsh & Powell 1967). A back has the number of its front.
std::vector<int> patch_colors(const PatchMesh& mesh);

}  // namespace lightwell
