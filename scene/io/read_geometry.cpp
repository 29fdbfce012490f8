#include <fmt/format.h>

#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <assimp/Importer.hpp>

#include "scene/errors.h"
#include "scene/io/mesh_file.h"
#include "scene/io/obj_materials.h"
#include "scene/io/polygon.h"
#include "scene/io/read_scene.h"
#include "scene/io/text_file.h"

namespace lightwell {
namespace {

[[noreturn]] void fail(const std::filesystem::path& path, const std::string& what) {
  throw InputError(fmt::format("{}: {}", path.string(), what));
}

PolygonMesh read_mesh(const std::filesystem::path& path, const aiMesh& mesh, double metres_per_unit,
                      Repairs& repairs) {
  const auto position = [&](unsigned v) {
    if (v >= mesh.mNumVertices) {
      fail(path,
           fmt::format("a face names vertex {}, but there are only {}", v, mesh.mNumVertices));
    }
    const aiVector3D& p = mesh.mVertices[v];
    const Eigen::Vector3d result = metres_per_unit * Eigen::Vector3d(p.x, p.y, p.z);
    if (!result.allFinite()) {
      fail(path, fmt::format("vertex {} has a coordinate that is not a finite number", v));
    }
    return result;
  };
  MeshBuilder builder;
  for (unsigned f = 0; f < mesh.mNumFaces; ++f) {
    const aiFace& face = mesh.mFaces[f];
    Loop loop;
    for (unsigned i = 0; i < face.mNumIndices; ++i) loop.push_back(position(face.mIndices[i]));
    add_repaired(builder, std::move(loop), repairs);
  }
  return builder.mesh();
}

}  // namespace

Scene read_geometry_file(const std::filesystem::path& path, double metres_per_unit,
                         MeshMaterials materials) {
  require_readable(path);
  Assimp::Importer importer;
  const aiScene* file = importer.ReadFile(path.string(), aiProcess_ValidateDataStructure);
  if (!file) fail(path, fmt::format("the file cannot be read: {}", importer.GetErrorString()));
  Scene scene{.file = path, .title = path.stem().string(), .metres_per_unit = metres_per_unit};
  scene.materials.push_back(default_material(scene.bands));
  if (materials == MeshMaterials::from_file) {
    scene.notes.push_back(
        "The file has no materials; every surface gets a diffuse reflectance of 0.5.");
  }
  Repairs repairs;
  for (unsigned m = 0; m < file->mNumMeshes; ++m) {
    PolygonMesh mesh = read_mesh(path, *file->mMeshes[m], metres_per_unit, repairs);
    if (mesh.facets.empty()) continue;
    const std::string stem = path.stem().string();
    scene.surfaces.push_back(
        {.name = file->mNumMeshes == 1 ? stem : fmt::format("{} {}", stem, m + 1),
         .shape = std::move(mesh)});
  }
  if (scene.surfaces.empty()) fail(path, "the file has no polygons with an area");
  for (const std::string& note : repairs.notes()) scene.notes.push_back(note + ".");
  validate(scene);
  return scene;
}

Scene read_geometry(const std::filesystem::path& path, double metres_per_unit) {
  return read_geometry_file(path, metres_per_unit, MeshMaterials::from_file);
}

}  // namespace lightwell
