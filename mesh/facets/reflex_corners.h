#pragma once

#include <vector>

#include "mesh/facets/facet_mesh.h"

namespace lightwell {

/// At a reflex corner, the foot of a block or the inner corner of an L-shaped room, what a point
/// sees depends on the direction in which the corner is approached: one side may be lit and the
/// other in the block's shadow. No one value is right for all, so each element there gets a vertex
/// of its own. Returns per vertex whether it is such a one.
std::vector<char> split_reflex_corners(FacetMesh& mesh);

}  // namespace lightwell
