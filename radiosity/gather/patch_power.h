#pragma once

#include <vector>

#include "mesh/patches/patch_mesh.h"

namespace lightwell {

/// Of each vertex, a patch that it is of: all are of one but where patches go on smoothly.
std::vector<int> vertex_patches(const PatchMesh& mesh);

/// Integral over each patch, m^2, of what is interpolated between vertices: patches x columns. Of
/// radiosity that is power, W.
Eigen::ArrayXXd patch_integral(const PatchMesh& mesh, const BandArray& vertex_values);

/// Of all power, what matters where a single patch is off by it: 0.2 %, and several times what a
/// patch holds in the mean, so that few patches do not all matter.
double notable_share(const PatchMesh& mesh);

/// Radiosity that was gathered at vertices, in columns of every channel. But a pool of light may
/// lie between vertices, or on one of them: patches whose power is off by a notable share of all
/// keep what is `even` over them, at all of their vertices.
BandArray with_pools(const PatchMesh& mesh, const BandArray& even, BandArray gathered);

}  // namespace lightwell
