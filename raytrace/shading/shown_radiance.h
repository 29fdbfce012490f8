#pragma once

#include <vector>

#include "radiosity/solve.h"
#include "scene/scene.h"

namespace lightwell {

/// Material of an element; null if `materials` ends before it.
const Material* find_material(const PatchMesh& mesh, const std::vector<Material>& materials,
                              int element);

/// Radiance drawn at each vertex, W/(m^2 sr), vertices x bands: B / pi. Mirrors and glass are drawn
/// as if they scattered the mirrored or the refracted light diffusely. A facet that shines by a
/// picture has the picture's mean.
BandArray shown_radiance(const PatchMesh& mesh, const RadiositySolution& solution,
                         const std::vector<Material>& materials);
BandArray shown_radiance(const SolvedScene& solved, const std::vector<Material>& materials);

/// Reflectance of a patch per band as shown_radiance uses it: diffuse, plus specular or the glass's
/// tint.
Spectrum shown_reflectance(const PatchMesh& mesh, const std::vector<Material>& materials,
                           int patch);

}  // namespace lightwell
