#pragma once

#include <filesystem>
#include <vector>

#include "scene/scene.h"

namespace lightwell {

/// Whether a mesh file's own materials matter; if not, everything is of one material, and neither
/// its MTL file nor its lack of one is spoken of.
enum class MeshMaterials { from_file, ignored };

/// Which polygon of a mesh file, counted from 0 in the file's order, each facet of the scene is or
/// is a piece of. Polygons that were dropped have no facet.
struct FilePolygons {
  int count = 0;
  std::vector<int> of_facet{};  ///< by scene-wide facet number
};

/// What read_obj() and read_geometry() do, but for the choice.
Scene read_obj_file(const std::filesystem::path& path, double metres_per_unit,
                    MeshMaterials materials, FilePolygons* polygons = nullptr);
Scene read_geometry_file(const std::filesystem::path& path, double metres_per_unit,
                         MeshMaterials materials, FilePolygons* polygons = nullptr);

}  // namespace lightwell
