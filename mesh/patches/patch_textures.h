#pragma once

#include "mesh/patches/patch_mesh.h"

namespace lightwell {

/// Sets areas, reflectances and emissions of a mesh of `scene` from textures and holes. An
/// element's area becomes the part that holes leave, and a patch's reflectance the mean of its
/// texture over that part. A patch's emission becomes the mean of its picture of emission. All are
/// sums over a grid of points on every element: from 4 to 16 in each direction, as fine as the
/// texels; 16 x 16 on facets with holes. Both sides of an element have the same numbers. An element
/// that is all hole keeps a thousandth of its area, which no light meets.
void lay_on_textures(const Scene& scene, PatchMesh& mesh);

/// Sets the textures and holes of a mesh that was read from a file.
void attach_textures(const Scene& scene, PatchMesh& mesh);

/// Mean of the picture of emission over an element of a facet that shines by one, W/m^2, before
/// relight() scales it.
Spectrum mean_emission(const PatchMesh& mesh, const FacetTextures& textures, int element);

/// Reflectance at vertices (vertices x bands): at a vertex of several patches, the mean weighted by
/// the area of their elements there.
BandArray vertex_reflectance(const PatchMesh& mesh);

}  // namespace lightwell
