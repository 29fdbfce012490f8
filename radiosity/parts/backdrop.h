#pragma once

#include <vector>

#include "mesh/patches/patch_mesh.h"
#include "scene/scene.h"

namespace lightwell {

/// Per patch, 1 for a dome that stands for the sky, or another surface far around all that is less
/// than a tenth as large.
std::vector<char> backdrop_patches(const Scene& scene, const PatchMesh& mesh);

}  // namespace lightwell
