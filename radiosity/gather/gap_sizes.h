#pragma once

#include <vector>

#include "mesh/patches/patch_mesh.h"

namespace lightwell {

/// Greatest width of a gap as a share of gap_sizes(). (Elements that were refined in a gap are
/// small, and still larger than the width over which light falls off.)
inline constexpr double widest_gap = 0.15;

/// Greatest cosine between the normals of surfaces that face each other.
inline constexpr double facing = -0.5;

/// Per element, the size, metres, that the width of a gap is compared with: that of the element's
/// patch, or twice that of its facet where the patch reaches over many smaller facets. The mesh has
/// a vertex at each corner of a facet, so such a patch shows light that varies from facet to facet.
/// (A patch of one facet has two elements along its edge by default, so twice their size.)
std::vector<float> gap_sizes(const PatchMesh& mesh);

}  // namespace lightwell
