#include "scene/io/numbered_scene.h"

#include "scene/io/clean_names.h"
#include "scene/io/mesh_file.h"
#include "scene/io/read_scene.h"
#include "scene/io/text_file.h"

namespace lightwell {
namespace {

void name_rows(NumberedScene& numbered) {
  const std::vector<FacetRef> facets = scene_facets(numbered.scene);
  for (std::size_t f = 0; f < facets.size(); ++f) {
    const auto row = static_cast<std::size_t>(numbered.row_of_facet[f]);
    const auto surface = static_cast<std::size_t>(facets[f].surface);
    numbered.rows[row].name = numbered.scene.surfaces[surface].name;
  }
}

}  // namespace

NumberedScene read_numbered_scene(const std::filesystem::path& path, References references) {
  const FilesRead read =
      references == References::inside_folder ? FilesRead::inside_folder_of(path) : FilesRead();
  const std::string extension = lower_extension(path);
  NumberedScene numbered;
  if (extension == ".vs3") {
    numbered = read_numbered_vs3(path);
    numbered.scene.files = read.files();
    clean_names(numbered.scene);
    return numbered;
  }
  FilePolygons polygons;
  if (extension == ".obj") {
    numbered.scene = read_obj_file(path, 1.0, MeshMaterials::ignored, &polygons);
  } else if (extension == ".ply" || extension == ".stl") {
    numbered.scene = read_geometry_file(path, 1.0, MeshMaterials::ignored, &polygons);
  } else {
    numbered.scene = read_scene(path);
    polygons.count = static_cast<int>(scene_facets(numbered.scene).size());
    for (int f = 0; f < polygons.count; ++f) polygons.of_facet.push_back(f);
  }
  numbered.scene.files = read.files();
  clean_names(numbered.scene);
  numbered.rows.resize(static_cast<std::size_t>(polygons.count));
  numbered.row_of_facet = std::move(polygons.of_facet);
  name_rows(numbered);
  return numbered;
}

}  // namespace lightwell
