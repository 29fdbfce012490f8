#pragma once

#include <filesystem>

#include "mesh/patches/patch_mesh.h"
#include "radiosity/solution/solution.h"

namespace lightwell {

enum class MeshSides { fronts, both };

/// Writes VTK PolyData (.vtp) for ParaView: the elements as polygons in metres, counter-clockwise
/// seen from the side they face, with cell data
///
/// - `element`, `patch`, `facet`, `surface`, `material`: numbers, from 0, as in a solution
/// - `patch_color`: see patch_colors(); `patch_rgb` is the same as an 8-bit colour, shown at first
/// - `area`, `patch_area`: m^2, exact on spheres
/// - `least_angle` (degrees), `aspect_ratio`: see element_shape()
/// - `is_back`: 1 on the backs of two-sided surfaces
///
/// and field data that say how it was made. Backs lie exactly on their fronts and are cut alike:
/// they are left out unless both sides are asked for. Written to a temporary name and renamed;
/// throws std::runtime_error naming the file and the system's reason if that fails.
void write_mesh(const std::filesystem::path& path, const PatchMesh& mesh, MeshSides sides,
                const Provenance& provenance);

}  // namespace lightwell
