#pragma once

#include "mesh/build_patches.h"
#include "mesh/geometry/patch_sizes.h"

namespace lightwell {

/// The sizes of cut_size() for what is near, growing with the distance from it (see
/// near_scenery()); or even ones, where options ask for a size, or where facets of surroundings
/// that cross what is near would make too many elements.
PatchSizes patch_sizes(const Scene& scene, const MeshOptions& options);

/// About how many elements the sizes make.
double predicted_elements(const Scene& scene, const PatchSizes& sizes);

}  // namespace lightwell
