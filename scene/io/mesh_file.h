#pragma once

#include <filesystem>
#include <vector>

#include "scene/io/polygon.h"
#include "scene/scene.h"

namespace lightwell {

/// Whether a mesh file's own materials matter; if not, everything is of one material, and neither
/// its MTL file nor its lack of one is spoken of. Facets keep their texture coordinates, v pointing
/// down from a picture's top, for materials of the file that show a picture, and `with_uv`.
enum class MeshMaterials { from_file, ignored, with_uv };

/// What tells a polygon's front: the order of its corners, or the side that the vertex normals the
/// file gives lie on, where it gives any.
enum class MeshFronts { from_winding, from_normals };

/// Which polygon of a mesh file, counted from 0 in the file's order, each facet of the scene is or
/// is a piece of. Polygons that were dropped have no facet.
struct FilePolygons {
  int count = 0;
  std::vector<int> of_facet{};  ///< by scene-wide facet number
  Repairs repairs{};
  bool has_normals = false;  ///< known if fronts were asked for from normals
};

/// What read_obj() and read_geometry() do, but for the choice.
Scene read_obj_file(const std::filesystem::path& path, double metres_per_unit,
                    MeshMaterials materials, FilePolygons* polygons = nullptr,
                    MeshFronts fronts = MeshFronts::from_winding);
Scene read_geometry_file(const std::filesystem::path& path, double metres_per_unit,
                         MeshMaterials materials, FilePolygons* polygons = nullptr,
                         MeshFronts fronts = MeshFronts::from_winding);

}  // namespace lightwell
