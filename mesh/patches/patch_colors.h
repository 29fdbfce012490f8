#pragma once

#include <vector>

#include "mesh/patches/patch_mesh.h"

namespace lightwell {

/// A small number >= 0 for each patch that no neighbour has, so that patches can be told apart when
/// shown by it. Neighbours share an edge of an element, also across facets and surfaces (ends
/// within 1e-9 of the mesh's extent are one). Greedy, by falling count of neighbours (Welsh &
/// Powell 1967). A back has the number of its front.
std::vector<int> patch_colors(const PatchMesh& mesh);

}  // namespace lightwell
