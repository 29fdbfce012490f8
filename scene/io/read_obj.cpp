#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <map>
#include <set>

#include "scene/errors.h"
#include "scene/io/mesh_file.h"
#include "scene/io/obj_materials.h"
#include "scene/io/polygon.h"
#include "scene/io/read_scene.h"
#include "scene/io/text_file.h"

namespace lightwell {
namespace {

// An f line; its corners are a range of ObjContent::corners.
struct ObjFace {
  int line = 0;
  int group = 0, material = -1;
  std::size_t first = 0, count = 0;
};

struct ObjContent {
  std::vector<Eigen::Vector3d> vertices{};
  std::vector<int> corners{};
  std::vector<ObjFace> faces{};
  std::vector<std::string> groups{};
  std::vector<std::string> material_names{};
  std::vector<std::string> material_files{};
  int free_form = 0;  ///< curves and surfaces
};

int index_of(std::vector<std::string>& names, const std::string& name) {
  const auto found = std::find(names.begin(), names.end(), name);
  if (found != names.end()) return static_cast<int>(found - names.begin());
  names.push_back(name);
  return static_cast<int>(names.size()) - 1;
}

class ObjParser {
 public:
  ObjParser(const TextFile& file, double metres_per_unit)
      : file_(file), metres_per_unit_(metres_per_unit) {}

  ObjContent parse() {
    std::string continued;
    int first_line = 0;
    file_.for_each_line([&](int line, std::string_view text) {
      if (continued.empty()) first_line = line;
      if (trimmed(text).ends_with('\\')) {
        const std::string_view part = trimmed(text);
        continued.append(part.substr(0, part.size() - 1)).append(" ");
        return;
      }
      line_ = first_line;
      if (continued.empty()) return read_line(text);
      continued += text;
      read_line(continued);
      continued.clear();
    });
    if (!continued.empty()) read_line(continued);
    check_indices();
    return std::move(content_);
  }

 private:
  void read_line(std::string_view text) {
    const std::string_view key = next_word(text);
    if (key == "v") {
      read_vertex(text);
    } else if (key == "f") {
      read_face(text);
    } else if (key == "o") {
      object_ = trimmed(text);
      in_group_ = false;
    } else if (key == "g") {
      group_ = trimmed(text);
      in_group_ = true;
    } else if (key == "usemtl") {
      material_ = index_of(content_.material_names, std::string(trimmed(text)));
    } else if (key == "mtllib") {
      content_.material_files.emplace_back(trimmed(text));
    } else if (key == "curv" || key == "curv2" || key == "surf") {
      ++content_.free_form;
    }
    if (key == "o" || key == "g") current_group_ = -1;
  }

  void read_vertex(std::string_view text) {
    Eigen::Vector3d p;
    for (double& x : p) {
      const std::string_view word = next_word(text);
      const auto value = parse_finite(word);
      if (!value) {
        file_.fail(line_, word.empty()
                              ? std::string("a vertex needs three coordinates")
                              : fmt::format("coordinate '{}' is not a finite number", word));
      }
      x = metres_per_unit_ * *value;
    }
    content_.vertices.push_back(p);
  }

  void read_face(std::string_view text) {
    ObjFace face{.line = line_,
                 .group = current_group(),
                 .material = material_,
                 .first = content_.corners.size()};
    for (auto word = next_word(text); !word.empty() && word.front() != '#';
         word = next_word(text)) {
      long index = 0;
      const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), index);
      if (error != std::errc() || (end != word.data() + word.size() && *end != '/')) {
        file_.fail(line_, fmt::format("'{}' is not a vertex index", word));
      }
      // Counted from 1, or backwards from the latest vertex.
      const long vertex =
          index < 0 ? static_cast<long>(content_.vertices.size()) + index : index - 1;
      if (vertex < 0 || vertex > std::numeric_limits<int>::max()) {
        file_.fail(line_,
                   fmt::format("vertex index {} is out of range; there are {} vertices before "
                               "this line",
                               index, content_.vertices.size()));
      }
      content_.corners.push_back(static_cast<int>(vertex));
    }
    face.count = content_.corners.size() - face.first;
    content_.faces.push_back(face);
  }

  // Only when all is read: a file may list its faces before its vertices.
  void check_indices() const {
    for (const ObjFace& face : content_.faces) {
      for (std::size_t i = 0; i < face.count; ++i) {
        const int vertex = content_.corners[face.first + i];
        if (vertex >= static_cast<int>(content_.vertices.size())) {
          file_.fail(face.line,
                     fmt::format("vertex index {} is out of range; the file has {} vertices",
                                 vertex + 1, content_.vertices.size()));
        }
      }
    }
  }

  // A "g" after an "o" divides the object; without one the group stands alone.
  int current_group() {
    if (current_group_ < 0) {
      const std::string name = !in_group_ || group_.empty() ? object_
                               : object_.empty() || object_ == group_
                                   ? group_
                                   : fmt::format("{}/{}", object_, group_);
      current_group_ =
          index_of(content_.groups, name.empty() ? file_.path().stem().string() : name);
    }
    return current_group_;
  }

  const TextFile& file_;
  double metres_per_unit_;
  int line_ = 0;
  std::string object_, group_;
  bool in_group_ = false;
  int current_group_ = -1, material_ = -1;
  ObjContent content_;
};

// "mtllib a.mtl b.mtl" names two files, "mtllib my room.mtl" usually one.
std::vector<std::filesystem::path> files_named(const std::filesystem::path& folder,
                                               std::string names) {
  std::replace(names.begin(), names.end(), '\\', '/');
  std::error_code error;
  if (std::filesystem::is_regular_file(folder / names, error)) return {folder / names};
  std::vector<std::filesystem::path> files;
  std::string_view rest = names;
  for (auto word = next_word(rest); !word.empty(); word = next_word(rest)) {
    files.push_back(folder / word);
  }
  return files;
}

std::vector<Material> read_materials(const std::filesystem::path& path, const ObjContent& content,
                                     std::vector<std::string>& notes) {
  std::vector<Material> materials;
  for (const std::string& names : content.material_files) {
    for (const auto& file : files_named(path.parent_path(), names)) {
      std::error_code error;
      if (!std::filesystem::is_regular_file(file, error)) {
        notes.push_back(fmt::format(
            "Material file '{}' is missing; its materials get a diffuse reflectance of 0.5.",
            file.string()));
        continue;
      }
      auto read = read_obj_materials(file, notes);
      materials.insert(materials.end(), std::make_move_iterator(read.begin()),
                       std::make_move_iterator(read.end()));
    }
  }
  return materials;
}

// The file's materials in the order of their first use; -1, the faces without one, maps to the
// default.
std::map<int, int> take_materials(const ObjContent& content, std::vector<Material> available,
                                  Scene& scene) {
  std::map<int, int> taken;
  std::size_t faces_without = 0;
  for (const ObjFace& face : content.faces) {
    faces_without += face.material < 0;
    const auto [entry, is_new] =
        taken.emplace(face.material, static_cast<int>(scene.materials.size()));
    if (!is_new) continue;
    Material material = default_material(scene.bands);
    if (face.material >= 0) {
      const auto& name = content.material_names[static_cast<std::size_t>(face.material)];
      const auto found = std::find_if(available.begin(), available.end(),
                                      [&](const Material& m) { return m.name == name; });
      if (found != available.end()) {
        material = *found;
      } else {
        material.name = name;
        scene.notes.push_back(fmt::format(
            "Material '{}' is not defined; it gets a diffuse reflectance of 0.5.", name));
      }
    }
    scene.materials.push_back(std::move(material));
  }
  if (faces_without > 0) {
    scene.notes.push_back(fmt::format("{} {} no material and got a diffuse reflectance of 0.5.",
                                      faces_without,
                                      faces_without == 1 ? "polygon names" : "polygons name"));
  }
  return taken;
}

void build_surfaces(const ObjContent& content, const std::map<int, int>& materials, Scene& scene,
                    FilePolygons& polygons) {
  std::map<std::pair<int, int>, std::size_t> surface_of;  // (group, material)
  std::vector<std::pair<int, int>> keys;
  std::vector<MeshBuilder> meshes;
  std::vector<std::vector<int>> polygons_of;  // by mesh, then facet
  std::map<int, std::set<int>> materials_of_group;
  Repairs repairs;
  for (const ObjFace& face : content.faces) {
    const std::pair key(face.group, materials.at(face.material));
    const auto [entry, is_new] = surface_of.emplace(key, meshes.size());
    if (is_new) {
      keys.push_back(key);
      meshes.emplace_back();
      polygons_of.emplace_back();
      materials_of_group[key.first].insert(key.second);
    }
    Loop loop;
    for (std::size_t i = 0; i < face.count; ++i) {
      loop.push_back(content.vertices[static_cast<std::size_t>(content.corners[face.first + i])]);
    }
    MeshBuilder& mesh = meshes[entry->second];
    add_repaired(mesh, std::move(loop), repairs);
    polygons_of[entry->second].resize(mesh.mesh().facets.size(), polygons.count);
    ++polygons.count;
  }
  for (std::size_t i = 0; i < meshes.size(); ++i) {
    if (meshes[i].empty()) continue;
    const auto [group, material] = keys[i];
    const std::string& name = content.groups[static_cast<std::size_t>(group)];
    const bool alone = materials_of_group[group].size() == 1;
    const std::string& of = scene.materials[static_cast<std::size_t>(material)].name;
    scene.surfaces.push_back({.name = alone ? name : fmt::format("{} ({})", name, of),
                              .material = material,
                              .shape = meshes[i].mesh()});
    polygons.of_facet.insert(polygons.of_facet.end(), polygons_of[i].begin(), polygons_of[i].end());
  }
  for (const std::string& note : repairs.notes()) scene.notes.push_back(note + ".");
}

}  // namespace

Scene read_obj_file(const std::filesystem::path& path, double metres_per_unit, MeshMaterials wanted,
                    FilePolygons* polygons) {
  const TextFile file(path);
  ObjContent content = ObjParser(file, metres_per_unit).parse();
  Scene scene{.file = path, .title = path.stem().string(), .metres_per_unit = metres_per_unit};
  if (content.free_form > 0) {
    scene.notes.push_back(fmt::format(
        "{} free-form curves and surfaces were left out; export polygons.", content.free_form));
  }
  std::map<int, int> materials = {{-1, 0}};
  if (wanted == MeshMaterials::from_file) {
    materials = take_materials(content, read_materials(path, content, scene.notes), scene);
  } else {
    for (ObjFace& face : content.faces) face.material = -1;
    scene.materials.push_back(default_material(scene.bands));
  }
  FilePolygons found;
  build_surfaces(content, materials, scene, found);
  if (polygons) *polygons = std::move(found);
  if (scene.surfaces.empty()) {
    throw InputError(fmt::format("{}: the file has no polygons with an area", path.string()));
  }
  validate(scene);
  return scene;
}

Scene read_obj(const std::filesystem::path& path, double metres_per_unit) {
  return read_obj_file(path, metres_per_unit, MeshMaterials::from_file);
}

}  // namespace lightwell
