#pragma once

#include "mesh/patches/patch_mesh.h"
#include "scene/bands.h"
#include "scene/scene.h"

namespace lightwell {

/// Shares of even light, [0,1], that the patches of a mesh mirror or pass straight on, patches x
/// bands: mean_specular() of their materials, and of their own means where patches have patterns.
BandArray mirrored_shares(const Scene& scene, const PatchMesh& mesh);

}  // namespace lightwell
