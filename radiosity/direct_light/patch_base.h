#pragma once

#include <optional>

#include "mesh/patches/patch_mesh.h"
#include "radiosity/direct_light/direct_light.h"
#include "scene/coat.h"

namespace lightwell {

/// The coated base of a patch, with the mean numbers of its pattern; empty: the patch has no coat.
std::optional<CoatedBase> base_of_patch(const DirectLight& direct_light, const PatchMesh& mesh,
                                        int patch);

}  // namespace lightwell
