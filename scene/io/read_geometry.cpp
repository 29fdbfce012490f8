#include <fmt/format.h>

#include <assimp/postprocess.h>
#include <assimp/scene.h>

#include <algorithm>
#include <assimp/Importer.hpp>
#include <cctype>
#include <fstream>
#include <string_view>

#include "scene/errors.h"
#include "scene/io/convex_cut.h"
#include "scene/io/default_material.h"
#include "scene/io/mesh_file.h"
#include "scene/io/polygon.h"
#include "scene/io/read_scene.h"
#include "scene/io/remarks.h"
#include "scene/io/text_file.h"

namespace lightwell {
namespace {

[[noreturn]] void fail_geometry(const std::filesystem::path& path, const std::string& what) {
  throw InputError(fmt::format("{}: {}", path.string(), what));
}

// Checks the header because the PLY reader of assimp 5.2 never returns from a truncated header,
// trusts any count, and takes a name that begins with digits for a count.
void check_ply_header(const std::filesystem::path& path) {
  std::ifstream stream(path, std::ios::binary);
  const auto bytes = static_cast<double>(std::filesystem::file_size(path));
  std::string line;
  for (int number = 1; std::getline(stream, line); ++number) {
    std::string_view rest = line;
    const std::string_view key = next_word(rest);
    if (number == 1 && key != "ply")
      fail_geometry(path, "this is no PLY file; its first line must be 'ply'");
    if (key == "end_header" && !stream.eof()) return;
    if (key != "element") continue;
    const std::string_view name = next_word(rest);
    if (name.empty() || std::isdigit(static_cast<unsigned char>(name.front())) != 0) {
      throw InputError(fmt::format(
          "{}:{}: the name of an element must begin with a letter; the file was damaged",
          path.string(), number));
    }
    const std::string_view given = next_word(rest);
    const auto count = parse_finite(given);
    if (!count || !(*count >= 0.0 && *count <= bytes)) {
      throw InputError(fmt::format(
          "{}:{}: the file is too short for so many of '{}' ({}); it was damaged or cut "
          "off",
          path.string(), number, excerpt(name), excerpt(given)));
    }
  }
  fail_geometry(path, "the header does not end with 'end_header'; the file was damaged or cut off");
}

PolygonMesh read_mesh(const std::filesystem::path& path, const aiMesh& mesh, double metres_per_unit,
                      bool with_uv, MeshFronts fronts, FilePolygons& polygons) {
  const auto position = [&](unsigned v) {
    if (v >= mesh.mNumVertices) {
      fail_geometry(
          path, fmt::format("a face names vertex {}, but there are only {}", v, mesh.mNumVertices));
    }
    const aiVector3D& p = mesh.mVertices[v];
    const Eigen::Vector3d result = metres_per_unit * Eigen::Vector3d(p.x, p.y, p.z);
    if (!result.allFinite()) {
      fail_geometry(path, fmt::format("vertex {} has a coordinate that is not a finite number", v));
    }
    return result;
  };
  const bool use_normals = fronts == MeshFronts::from_normals && mesh.HasNormals();
  polygons.has_normals = polygons.has_normals || use_normals;
  MeshBuilder builder;
  for (unsigned f = 0; f < mesh.mNumFaces; ++f) {
    const aiFace& face = mesh.mFaces[f];
    Loop loop;
    UvLoop uv;
    NormalLoop normals;
    Eigen::Vector3d normal = Eigen::Vector3d::Zero();
    for (unsigned i = 0; i < face.mNumIndices; ++i) {
      const unsigned v = face.mIndices[i];
      loop.push_back(position(v));
      if (with_uv && mesh.HasTextureCoords(0)) {
        const aiVector3D& at = mesh.mTextureCoords[0][v];
        uv.emplace_back(at.x, 1.0 - at.y);
      }
      if (!mesh.HasNormals()) continue;
      const aiVector3D& n = mesh.mNormals[v];
      normals.emplace_back(n.x, n.y, n.z);
      if (use_normals) normal += normals.back();
    }
    if (loop.size() >= 3 && area_vector(loop).dot(normal) < 0.0) {
      std::reverse(loop.begin(), loop.end());
      std::reverse(uv.begin(), uv.end());
      std::reverse(normals.begin(), normals.end());
    }
    const std::size_t facets_before = builder.mesh().facets.size();
    add_repaired(builder, std::move(loop), polygons.repairs, std::move(uv), std::move(normals));
    polygons.of_facet.insert(polygons.of_facet.end(), builder.mesh().facets.size() - facets_before,
                             polygons.count);
    ++polygons.count;
  }
  return builder.mesh();
}

}  // namespace

Scene read_geometry_file(const std::filesystem::path& path, double metres_per_unit,
                         MeshMaterials materials, FilePolygons* polygons, MeshFronts fronts) {
  require_readable(path);
  if (lower_extension(path) == ".ply") check_ply_header(path);
  Assimp::Importer importer;
  const aiScene* file = importer.ReadFile(path.string(), aiProcess_ValidateDataStructure);
  if (!file)
    fail_geometry(path, fmt::format("the file cannot be read: {}", importer.GetErrorString()));
  Scene scene{.file = path, .title = path.stem().string(), .metres_per_unit = metres_per_unit};
  scene.materials.push_back(default_material(scene.bands));
  if (materials == MeshMaterials::from_file) {
    scene.notes.emplace_back(
        "The file has no materials; every surface gets a diffuse reflectance of 0.5.");
  }
  FilePolygons found;
  for (unsigned m = 0; m < file->mNumMeshes; ++m) {
    PolygonMesh mesh = read_mesh(path, *file->mMeshes[m], metres_per_unit,
                                 materials == MeshMaterials::with_uv, fronts, found);
    if (mesh.facets.empty()) continue;
    const std::string stem = path.stem().string();
    scene.surfaces.push_back(
        {.name = file->mNumMeshes == 1 ? stem : fmt::format("{} {}", stem, m + 1),
         .shape = std::move(mesh)});
  }
  if (scene.surfaces.empty()) {
    throw NoAreaError(fmt::format("{}: the file has no polygons with an area", path.string()));
  }
  note_repairs(found.repairs, scene);
  if (polygons) *polygons = std::move(found);
  validate(scene);
  return scene;
}

Scene read_geometry(const std::filesystem::path& path, double metres_per_unit) {
  return read_geometry_file(path, metres_per_unit, MeshMaterials::from_file);
}

}  // namespace lightwell
