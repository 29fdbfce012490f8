#pragma once

#include <filesystem>

#include "scene/io/mesh_file.h"
#include "scene/scene.h"

namespace lightwell {

/// Reads mesh `number` (from 0) of a .serialized file: zlib-compressed triangles, versions 3 and 4,
/// little-endian, as the documentation of Mitsuba 0.6 describes them ("serialized", section 8.1).
/// The result is one surface of the default material. `polygons` receives the triangle of each
/// facet. Counts are checked against the size of the file before memory is taken. Throws InputError
/// naming the file and the fault, NoAreaError for a mesh without triangles that have an area, and
/// LimitError for too many triangles.
Scene read_serialized_file(const std::filesystem::path& path, int number, MeshMaterials materials,
                           FilePolygons& polygons, MeshFronts fronts);

}  // namespace lightwell
