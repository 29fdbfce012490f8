#pragma once

#include "mesh/patches/patch_mesh.h"
#include "scene/scene.h"

namespace lightwell {

/// The box about all vertices, metres; without vertices, from infinity to minus infinity.
Bounds mesh_bounds(const PatchMesh& mesh);
/// The same without facets of a backdrop, see scenery_box().
Bounds scenery_bounds(const PatchMesh& mesh);

}  // namespace lightwell
