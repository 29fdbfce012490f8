#pragma once

#include "mesh/patches/patch_mesh.h"

namespace lightwell {

/// Integral over each patch of values interpolated between vertices (vertices x columns): patches x
/// columns, in m^2 times the unit of the values. The integral of radiosity is power, W.
Eigen::ArrayXXd patch_integral(const PatchMesh& mesh, const BandArray& vertex_values);

/// The error of a single patch's power that matters, as a share of all power: 0.2 %, or four
/// patches' mean share if that is more, so that not every patch of a few matters.
double notable_share(const PatchMesh& mesh);

/// The `gathered` radiosity, but the radiosity `even` at all vertices of patches whose two powers
/// differ by a notable share of all (see notable_share): in such a patch a pool of light may lie
/// between vertices or on one of them. `even` follows from the patches' equations. Both are
/// vertices x columns, W/m^2.
BandArray with_pools(const PatchMesh& mesh, const BandArray& even, BandArray gathered);

}  // namespace lightwell
