#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <set>
#include <string>
#include <utility>

#include "scene/io/mesh_file.h"
#include "scene/io/scene_size.h"
#include "scene/io/toml/toml_value.h"
#include "scene/scene.h"

namespace lightwell {

/// Converts [[surfaces]] tables to the surfaces of a scene, whose materials must be complete;
/// materials of an OBJ file are added at first use.
class TomlSurfaces {
 public:
  explicit TomlSurfaces(Scene& scene);

  /// Adds the surface of a table, or several surfaces for a mesh of several objects. Throws
  /// InputError, and LimitError for a scene of too many triangles.
  void add(const TomlValue& value, std::size_t number);

 private:
  class Reader;
  Scene mesh_of(const std::filesystem::path& path, MeshMaterials wanted);
  int material_of(const std::string& name) const;
  int add_material(Material material);

  Scene& scene_;
  std::map<std::string, int, std::less<>> materials_{};  // indices by name
  std::set<std::string> names_{};
  SceneSize size_;
  // Small meshes, of which scenes may have very many.
  std::map<std::pair<std::filesystem::path, MeshMaterials>, Scene> meshes_{};
};

}  // namespace lightwell
