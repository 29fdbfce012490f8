#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "scene/errors.h"
#include "scene/io/polygon.h"
#include "scene/io/polygon_repair.h"
#include "scene/scene.h"

namespace lightwell {

/// Use of a mesh file's own materials.
/// from_file: the file's materials.
/// ignored: one material for everything; neither the MTL file nor its absence adds a note.
/// with_uv: as ignored, with texture coordinates kept (v points down from a picture's top).
/// With from_file, facets keep texture coordinates where their material has a picture.
enum class MeshMaterials { from_file, ignored, with_uv };

/// Definition of a polygon's front: by the order of its corners, or by the side of the file's
/// vertex normals where the file has any.
enum class MeshFronts { from_winding, from_normals };

/// Polygon of the mesh file (counted from 0 in the file's order) to which each facet of the scene
/// belongs. A polygon may be split into several facets. Polygons that were dropped have no facet.
struct FilePolygons {
  int count = 0;
  std::vector<int> of_facet{};  ///< by scene-wide facet number
  Repairs repairs{};
  bool has_normals = false;  ///< set only with MeshFronts::from_normals
};

/// Thrown for a mesh file without polygons that have an area.
class NoAreaError : public InputError {
  using InputError::InputError;
};

/// The error of a mesh file without polygons that have an area: a NoAreaError, or an InputError
/// that names a vertex if polygons were dropped for vertices without finite coordinates.
[[noreturn]] void fail_without_area(const std::filesystem::path& file, const Repairs& repairs);

/// read_obj() and read_geometry() with a choice of materials and fronts. `polygons`, if not null,
/// receives the polygon of each facet.
Scene read_obj_file(const std::filesystem::path& path, double metres_per_unit,
                    MeshMaterials materials, FilePolygons* polygons = nullptr,
                    MeshFronts fronts = MeshFronts::from_winding);
/// read_obj_file() with the file's materials, for a scene that replaces those of which
/// `is_replaced(name)` is true: no note says that a replaced material is missing in the files.
Scene read_obj_part(const std::filesystem::path& path, double metres_per_unit,
                    const std::function<bool(const std::string&)>& is_replaced);
Scene read_geometry_file(const std::filesystem::path& path, double metres_per_unit,
                         MeshMaterials materials, FilePolygons* polygons = nullptr,
                         MeshFronts fronts = MeshFronts::from_winding);

/// Surfaces and materials of a COLLADA or FBX file, a mesh of another scene. The file has a unit of
/// its own; coordinates are metres times `units_per_metre`.
Scene read_interchange_file(const std::filesystem::path& path, double units_per_metre,
                            MeshMaterials materials);

}  // namespace lightwell
