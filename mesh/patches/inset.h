#pragma once

#include "mesh/patches/patch_mesh.h"

namespace lightwell {

/// Distance from the border of an element, metres, below which rays do not tell its two sides: 16
/// times the rounding of coordinates in single precision, of half the mesh's diagonal.
double least_inset(const PatchMesh& mesh);

/// Share of the way from a corner or an edge of an element to its centre, at which light is
/// gathered for that place: `share`, or the share at which the point is `least` metres off all
/// borders, as far as half of the way allows.
double inset_share(const PatchMesh& mesh, int element, double share, double least);

}  // namespace lightwell
