#pragma once

#include "mesh/patches/patch_mesh.h"
#include "scene/scene.h"

namespace lightwell {

/// The box about all vertices, metres; without vertices, from infinity to minus infinity.
Bounds mesh_bounds(const PatchMesh& mesh);
/// The same without facets of a backdrop, see scenery_box().
Bounds scenery_bounds(const PatchMesh& mesh);
/// Flags of the scene's facets: 1 for a facet that has elements and is near, see near_scenery().
std::vector<char> near_facets(const PatchMesh& mesh);

}  // namespace lightwell
