#pragma once

#include "mesh/patches/patch_mesh.h"

namespace lightwell {

/// PatchMesh::least_inset of a mesh with vertices in a box of the given diagonal, metres: 16 times
/// the rounding of coordinates in single precision.
double least_inset(double diagonal);

/// Share of the way from a corner or an edge of an element to its centre, at which a point stands
/// for that place: `share`, or the share at which the point is PatchMesh::least_inset off all
/// borders, as far as half of the way allows.
double inset_share(const PatchMesh& mesh, int element, double share);

/// About the distance of an element's centre from its nearest border, metres: half of the area over
/// the longest edge. That is exact for rectangles; the centre of a triangle is a third more away.
double off_border(const PatchMesh& mesh, int element);

/// inset_share() for a patch whose centre is `off_border` metres off the nearest border.
double inset_share(const PatchMesh& mesh, double off_border, double share);

}  // namespace lightwell
