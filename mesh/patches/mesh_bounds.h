#pragma once

#include "mesh/patches/patch_mesh.h"
#include "scene/scene.h"

namespace lightwell {

/// The box about all vertices, m; empty, from infinity to minus infinity, without any.
Bounds mesh_bounds(const PatchMesh& mesh);

}  // namespace lightwell
