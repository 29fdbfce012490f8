#pragma once

#include "mesh/patches/patch_mesh.h"

namespace lightwell {

/// Puts what varies over the scene's facets into the mesh that was made of it. An element's area
/// becomes that of what its holes leave, and a patch's reflectance the mean of its texture over
/// what they leave, both from a grid of points on every element, 4 x 4 or as fine as the texels, 16
/// x 16 at most, where there are holes always. What is holes throughout keeps a thousandth of its
/// area, which no light meets.
void lay_on_textures(const Scene& scene, PatchMesh& mesh);

/// Gives a mesh that was read from a file the holes of its scene's facets.
void attach_textures(const Scene& scene, PatchMesh& mesh);

/// Reflectance at vertices: of patches that share one, the mean by the area of their elements there
/// (vertices x bands).
BandArray vertex_reflectance(const PatchMesh& mesh);

}  // namespace lightwell
