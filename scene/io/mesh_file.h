#pragma once

#include <filesystem>

#include "scene/scene.h"

namespace lightwell {

/// Whether a mesh file's own materials matter; if not, everything is of one material, and neither
/// its MTL file nor its lack of one is spoken of.
enum class MeshMaterials { from_file, ignored };

/// What read_obj() and read_geometry() do, but for the choice.
Scene read_obj_file(const std::filesystem::path& path, double metres_per_unit,
                    MeshMaterials materials);
Scene read_geometry_file(const std::filesystem::path& path, double metres_per_unit,
                         MeshMaterials materials);

}  // namespace lightwell
