#pragma once

#include <vector>

#include "mesh/facets/facet_mesh.h"

namespace lightwell {

/// Gives every element at a reflex corner a vertex of its own. At such a corner, the foot of a
/// block or the inner corner of an L-shaped room, the view depends on the direction of approach:
/// one side may be lit and the other in the block's shadow, so no one value is right for all
/// elements. Returns per vertex 1 if it lies at a reflex corner.
std::vector<char> split_reflex_corners(FacetMesh& mesh);

}  // namespace lightwell
