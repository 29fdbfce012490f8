#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <map>
#include <set>

#include "scene/errors.h"
#include "scene/io/convex_cut.h"
#include "scene/io/corner_maps.h"
#include "scene/io/default_material.h"
#include "scene/io/foreign_path.h"
#include "scene/io/mesh_builder.h"
#include "scene/io/mesh_file.h"
#include "scene/io/numbered_names.h"
#include "scene/io/obj/obj_file.h"
#include "scene/io/obj/obj_materials.h"
#include "scene/io/polygon.h"
#include "scene/io/polygon_repair.h"
#include "scene/io/read_scene.h"
#include "scene/io/remarks.h"
#include "scene/io/text_file.h"

namespace lightwell {
namespace {

// Paths in an mtllib line: "a.mtl b.mtl" names two files, "my room.mtl" usually one.
std::vector<std::filesystem::path> files_named(const std::filesystem::path& folder,
                                               const std::string& names) {
  if (auto found = find_foreign_file(folder, std::string(without_quotes(names)))) return {*found};
  std::vector<std::filesystem::path> files;
  std::string_view rest = names;
  for (auto word = next_word(rest); !word.empty() && word.front() != '#'; word = next_word(rest)) {
    const std::string_view name = without_quotes(word);
    files.push_back(find_foreign_file(folder, std::string(name)).value_or(folder / name));
  }
  return files;
}

// Tells whether the scene around the file has a material of its own by a name; empty: none.
using IsReplaced = std::function<bool(const std::string&)>;

struct MaterialFiles {
  std::vector<Material> materials{};
  std::vector<std::string> missing{};  // files
};

// Reads the materials that faces show. Those that the scene replaces may lack their pictures.
MaterialFiles read_material_files(const std::filesystem::path& path, const ObjContent& content,
                                  const IsReplaced& is_replaced, Remarks& remarks) {
  std::set<std::string, std::less<>> shown;
  for (const ObjFace& face : content.faces) {
    if (face.material < 0) continue;
    const auto& name = content.material_names[static_cast<std::size_t>(face.material)];
    if (!(is_replaced && is_replaced(name))) shown.insert(name);
  }
  const auto is_shown = [&](const std::string& name) { return shown.contains(name); };
  MaterialFiles result;
  for (const std::string& names : content.material_files) {
    for (const auto& file : files_named(path.parent_path(), names)) {
      if (!is_file(file)) {
        result.missing.push_back(file.string());
        continue;
      }
      auto read = read_obj_materials(file, is_shown, remarks);
      result.materials.insert(result.materials.end(), std::make_move_iterator(read.begin()),
                              std::make_move_iterator(read.end()));
    }
  }
  return result;
}

// Remarks on materials that faces use and nobody defines, and on the missing files that may define
// these materials.
void remark_undefined(const ObjContent& content, const MaterialFiles& files,
                      const IsReplaced& is_replaced, Remarks& remarks) {
  std::set<std::string, std::less<>> defined;
  for (const Material& material : files.materials) defined.insert(material.name);
  std::vector<std::string> undefined;
  bool uses_any = false;
  for (const ObjFace& face : content.faces) {
    if (face.material < 0) continue;
    uses_any = true;
    const auto& name = content.material_names[static_cast<std::size_t>(face.material)];
    const bool is_new = defined.insert(name).second;
    if (is_new && !(is_replaced && is_replaced(name))) undefined.push_back(name);
  }
  if (!uses_any || !undefined.empty()) {
    for (const std::string& file : files.missing) {
      remarks.add(
          "Material files are missing, and their materials got a diffuse reflectance of 0.5", file);
    }
  }
  for (const std::string& name : undefined) {
    remarks.add("Materials are not defined and got a diffuse reflectance of 0.5", name);
  }
}

// Adds the file's materials to the scene in the order of first use. The key -1 (faces without a
// material) maps to the default material.
std::map<int, int> take_materials(const ObjContent& content, const std::vector<Material>& available,
                                  Scene& scene) {
  std::map<std::string, const Material*, std::less<>> by_name;  // the first of equal names
  for (const Material& material : available) by_name.emplace(material.name, &material);
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
      const auto found = by_name.find(name);
      if (found != by_name.end()) {
        material = *found->second;
      } else {
        material.name = name;
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

// Texture coordinates at the corners of a face; empty if a corner has none.
UvLoop uv_of(const ObjContent& content, const ObjFace& face) {
  UvLoop uv;
  for (std::size_t i = face.first; i < face.first + face.count; ++i) {
    const int at = i < content.corner_uv.size() ? content.corner_uv[i] : -1;
    if (at < 0) return {};
    uv.push_back(content.uv[static_cast<std::size_t>(at)]);
    if (!uv.back().allFinite()) return {};
  }
  return uv;
}

// Normals at the corners of a face; empty if a corner has none.
NormalLoop normals_of(const ObjContent& content, const ObjFace& face) {
  NormalLoop normals;
  for (std::size_t i = face.first; i < face.first + face.count; ++i) {
    const int normal = i < content.corner_normals.size() ? content.corner_normals[i] : -1;
    if (normal < 0) return {};
    normals.push_back(content.normals[static_cast<std::size_t>(normal)]);
  }
  return normals;
}

// True if the corner normals lie on the side opposite to the front by winding.
bool turned_by_normals(const ObjContent& content, const ObjFace& face, const Loop& loop) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (std::size_t i = face.first; i < face.first + face.count; ++i) {
    const int normal = i < content.corner_normals.size() ? content.corner_normals[i] : -1;
    if (normal >= 0) sum += content.normals[static_cast<std::size_t>(normal)];
  }
  return loop.size() >= 3 && area_vector(loop).dot(sum) < 0.0;
}

struct ObjRequest {
  double metres_per_unit = 1.0;
  MeshMaterials wanted = MeshMaterials::from_file;
  MeshFronts fronts = MeshFronts::from_winding;
  IsReplaced is_replaced{};
};

// True for each material of the scene whose facets keep texture coordinates. A material from
// another source is unknown here: the caller decides (with_uv), or drops what a replaced one has no
// use for.
std::vector<char> materials_with_uv(const Scene& scene, const ObjRequest& request) {
  std::vector<char> keeps_uv;
  for (const Material& m : scene.materials) {
    const bool is_unknown = request.wanted == MeshMaterials::with_uv ||
                            (request.is_replaced && request.is_replaced(m.name));
    keeps_uv.push_back(is_unknown || m.shows_picture() ? 1 : 0);
  }
  return keeps_uv;
}

// The first vertex of a face that has no finite coordinates; null if all have them.
const PlacelessVertex* placeless_vertex(const ObjContent& content, const ObjFace& face) {
  if (content.placeless.empty()) return nullptr;
  for (std::size_t i = face.first; i < face.first + face.count; ++i) {
    const auto found = content.placeless.find(content.corners[i]);
    if (found != content.placeless.end()) return &found->second;
  }
  return nullptr;
}

void build_surfaces(const ObjContent& content, const std::map<int, int>& materials,
                    const ObjRequest& request, Scene& scene, FilePolygons& polygons) {
  const std::vector<char> keeps_uv = materials_with_uv(scene, request);
  std::map<std::pair<int, int>, std::size_t> surface_of;  // (group, material)
  std::vector<std::pair<int, int>> keys;
  std::vector<MeshBuilder> meshes;
  std::vector<std::vector<int>> polygons_of;  // by mesh, then facet
  std::map<int, std::set<int>> materials_of_group;
  const bool by_normals = request.fronts == MeshFronts::from_normals;
  polygons.has_normals = by_normals && !content.normals.empty();
  for (const ObjFace& face : content.faces) {
    if (const PlacelessVertex* vertex = placeless_vertex(content, face)) {
      polygons.repairs.drop_placeless(fmt::format("{}:{}: coordinate '{}' is not a finite number",
                                                  scene.file.string(), vertex->line, vertex->word));
      ++polygons.count;
      continue;
    }
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
    UvLoop uv = keeps_uv[static_cast<std::size_t>(key.second)] ? uv_of(content, face) : UvLoop{};
    NormalLoop normals = normals_of(content, face);
    if (by_normals && turned_by_normals(content, face, loop)) {
      std::reverse(loop.begin(), loop.end());
      std::reverse(uv.begin(), uv.end());
      std::reverse(normals.begin(), normals.end());
    }
    MeshBuilder& mesh = meshes[entry->second];
    add_repaired(mesh, std::move(loop), polygons.repairs, std::move(uv), std::move(normals));
    polygons_of[entry->second].resize(mesh.mesh().facets.size(), polygons.count);
    ++polygons.count;
  }
  for (std::size_t i = 0; i < meshes.size(); ++i) {
    if (meshes[i].empty()) continue;
    const auto [group, material] = keys[i];
    const std::string& name = content.groups[static_cast<std::size_t>(group)];
    const bool alone = materials_of_group[group].size() == 1;
    const std::string& of = scene.materials[static_cast<std::size_t>(material)].name;
    scene.surfaces.push_back({.name = shortened(alone ? name : fmt::format("{} ({})", name, of)),
                              .material = material,
                              .shape = meshes[i].mesh()});
    polygons.of_facet.insert(polygons.of_facet.end(), polygons_of[i].begin(), polygons_of[i].end());
  }
}

Scene read_requested(const std::filesystem::path& path, const ObjRequest& request,
                     FilePolygons* polygons) {
  const TextFile file(path);
  ObjContent content = read_obj_content(file, request.metres_per_unit);
  Scene scene{
      .file = path, .title = path.stem().string(), .metres_per_unit = request.metres_per_unit};
  if (content.free_form > 0) {
    add_loss(scene, fmt::format("{} free-form curves and surfaces were left out; export polygons.",
                                content.free_form));
  }
  Remarks remarks;
  std::map<int, int> materials = {{-1, 0}};
  if (request.wanted == MeshMaterials::from_file) {
    const MaterialFiles files = read_material_files(path, content, request.is_replaced, remarks);
    remark_undefined(content, files, request.is_replaced, remarks);
    materials = take_materials(content, files.materials, scene);
  } else {
    for (ObjFace& face : content.faces) face.material = -1;
    scene.materials.push_back(default_material(scene.bands));
  }
  FilePolygons found;
  build_surfaces(content, materials, request, scene, found);
  remark_pictures_without_uv(scene, remarks);
  remarks.report_to(scene);
  note_repairs(found.repairs, scene);
  if (scene.surfaces.empty()) fail_without_area(path, found.repairs);
  if (polygons) *polygons = std::move(found);
  validate(scene);
  return scene;
}

}  // namespace

Scene read_obj_file(const std::filesystem::path& path, double metres_per_unit, MeshMaterials wanted,
                    FilePolygons* polygons, MeshFronts fronts) {
  return read_requested(
      path, {.metres_per_unit = metres_per_unit, .wanted = wanted, .fronts = fronts}, polygons);
}

Scene read_obj_part(const std::filesystem::path& path, double metres_per_unit,
                    const std::function<bool(const std::string&)>& is_replaced) {
  return read_requested(path, {.metres_per_unit = metres_per_unit, .is_replaced = is_replaced},
                        nullptr);
}

Scene read_obj(const std::filesystem::path& path, double metres_per_unit) {
  return read_obj_file(path, metres_per_unit, MeshMaterials::from_file);
}

}  // namespace lightwell
