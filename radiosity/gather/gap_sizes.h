#pragma once

#include <vector>

#include "mesh/patches/patch_mesh.h"

namespace lightwell {

/// Per element, the size, metres, that the width of a gap is compared with: that of the element's
/// patch, or twice that of its facet where the patch reaches over many smaller facets. The mesh has
/// a vertex at each corner of a facet, so such a patch shows light that varies from facet to facet.
/// (A patch of one facet has two elements along its edge by default, so twice their size.)
std::vector<float> gap_sizes(const PatchMesh& mesh);

}  // namespace lightwell
