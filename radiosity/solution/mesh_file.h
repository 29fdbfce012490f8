#pragma once

#include <filesystem>

#include "mesh/patches/patch_mesh.h"
#include "radiosity/solution/solution.h"

namespace lightwell {

enum class MeshSides { fronts, both };

/// Writes VTK PolyData (.vtp) for ParaView. Elements are polygons, in metres, counter-clockwise
/// seen from the side that the element faces. Cell data:
///
/// - `element`, `patch`, `facet`, `surface`, `material`: numbers from 0, as in a solution -
/// `patch_color`: see patch_colors(); `patch_rgb` is the same as an 8-bit colour, the active
/// scalars - `area`, `patch_area`: m^2, exact on round shapes - `least_angle` (degrees),
/// `aspect_ratio`: see element_shape() - `is_back`: 1 on the backs of two-sided surfaces
///
/// Field data hold the provenance. Backs coincide with their fronts and have the same elements, so
/// backs are left out unless `sides` is `both`. The file is written under a temporary name and
/// renamed. Throws std::runtime_error naming the file and the system's reason if writing fails.
void write_mesh(const std::filesystem::path& path, const PatchMesh& mesh, MeshSides sides,
                const Provenance& provenance);

}  // namespace lightwell
