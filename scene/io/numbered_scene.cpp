#include "scene/io/numbered_scene.h"

#include <numeric>
#include <utility>

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

NumberedScene numbered_by_facets(Scene scene) {
  NumberedScene numbered;
  numbered.row_of_facet.resize(scene_facets(scene).size());
  std::iota(numbered.row_of_facet.begin(), numbered.row_of_facet.end(), 0);
  numbered.rows.resize(numbered.row_of_facet.size());
  numbered.scene = std::move(scene);
  name_rows(numbered);
  return numbered;
}

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
    numbered = numbered_by_facets(read_scene(path));
    numbered.scene.files = read.files();
    return numbered;
  }
  numbered.scene.files = read.files();
  clean_names(numbered.scene);
  numbered.rows.resize(static_cast<std::size_t>(polygons.count));
  numbered.row_of_facet = std::move(polygons.of_facet);
  name_rows(numbered);
  return numbered;
}

}  // namespace lightwell
