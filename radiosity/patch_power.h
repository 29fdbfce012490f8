#pragma once

#include "mesh/patch_mesh.h"

namespace lightwell {

/// Power of each patch, W, as interpolation of the radiosity at vertices has it: patches x columns.
Eigen::ArrayXXd patch_power(const PatchMesh& mesh, const BandArray& vertex_radiosity);

/// Of all power, what matters where a single patch is off by it: 0.2 %, and several times what a
/// patch holds in the mean, so that few patches do not all matter.
double notable_share(const PatchMesh& mesh);

/// Radiosity that was gathered at vertices, in columns of every channel. But a pool of light may
/// lie between vertices, or on one of them: patches whose power is off by a notable share of all
/// keep what is `even` over them, at all of their vertices.
BandArray with_pools(const PatchMesh& mesh, const BandArray& even, BandArray gathered);

}  // namespace lightwell
