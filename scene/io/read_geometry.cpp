#include <fmt/format.h>

#include <assimp/postprocess.h>
#include <assimp/scene.h>

#include <algorithm>
#include <assimp/Importer.hpp>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "scene/errors.h"
#include "scene/io/convex_cut.h"
#include "scene/io/corner_maps.h"
#include "scene/io/default_material.h"
#include "scene/io/mesh_builder.h"
#include "scene/io/mesh_file.h"
#include "scene/io/ply_file.h"
#include "scene/io/polygon.h"
#include "scene/io/polygon_repair.h"
#include "scene/io/read_scene.h"
#include "scene/io/remarks.h"
#include "scene/io/text_file.h"

namespace lightwell {
namespace {

[[noreturn]] void fail_geometry(const std::filesystem::path& path, const std::string& what) {
  throw InputError(fmt::format("{}: {}", path.string(), what));
}

// Reads an STL file with assimp, a mesh for each of its solids.
std::vector<IndexedPolygons> read_with_assimp(const std::filesystem::path& path) {
  Assimp::Importer importer;
  const aiScene* file = importer.ReadFile(path.string(), aiProcess_ValidateDataStructure);
  if (!file)
    fail_geometry(path, fmt::format("the file cannot be read: {}", importer.GetErrorString()));
  std::vector<IndexedPolygons> meshes;
  for (unsigned m = 0; m < file->mNumMeshes; ++m) {
    const aiMesh& from = *file->mMeshes[m];
    IndexedPolygons& mesh = meshes.emplace_back();
    for (unsigned v = 0; v < from.mNumVertices; ++v) {
      const aiVector3D& p = from.mVertices[v];
      mesh.positions.emplace_back(p.x, p.y, p.z);
      if (!from.HasNormals()) continue;
      const aiVector3D& n = from.mNormals[v];
      mesh.normals.emplace_back(n.x, n.y, n.z);
    }
    for (unsigned f = 0; f < from.mNumFaces; ++f) {
      const aiFace& face = from.mFaces[f];
      mesh.polygons.emplace_back(face.mIndices, face.mIndices + face.mNumIndices);
    }
  }
  return meshes;
}

PolygonMesh read_mesh(const std::filesystem::path& path, const IndexedPolygons& mesh,
                      double metres_per_unit, bool with_uv, MeshFronts fronts,
                      FilePolygons& polygons) {
  const auto position = [&](std::uint32_t v) {
    if (v >= mesh.positions.size()) {
      fail_geometry(path, fmt::format("a face names vertex {}, but there are only {}", v,
                                      mesh.positions.size()));
    }
    return Eigen::Vector3d(metres_per_unit * mesh.positions[v]);
  };
  const bool use_normals = fronts == MeshFronts::from_normals && !mesh.normals.empty();
  polygons.has_normals = polygons.has_normals || use_normals;
  MeshBuilder builder;
  for (const std::vector<std::uint32_t>& corners : mesh.polygons) {
    Loop loop;
    UvLoop uv;
    NormalLoop normals;
    Eigen::Vector3d normal = Eigen::Vector3d::Zero();
    for (const std::uint32_t v : corners) {
      loop.push_back(position(v));
      if (with_uv && !mesh.uv.empty()) uv.emplace_back(mesh.uv[v].x(), 1.0 - mesh.uv[v].y());
      if (mesh.normals.empty()) continue;
      normals.push_back(mesh.normals[v]);
      if (use_normals) normal += normals.back();
    }
    if (const auto corner = placeless_corner(loop)) {
      polygons.repairs.drop_placeless(
          fmt::format("{}: vertex {} has a coordinate that is not a finite number", path.string(),
                      corners[*corner]));
      ++polygons.count;
      continue;
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

void fail_without_area(const std::filesystem::path& file, const Repairs& repairs) {
  if (repairs.placeless == 0) {
    throw NoAreaError(fmt::format("{}: the file has no polygons with an area", file.string()));
  }
  throw InputError(
      fmt::format("{}: the file has no polygons with an area and finite coordinates; {}",
                  file.string(), repairs.first_placeless));
}

Scene read_geometry_file(const std::filesystem::path& path, double metres_per_unit,
                         MeshMaterials materials, FilePolygons* polygons, MeshFronts fronts) {
  require_readable(path);
  const std::vector<IndexedPolygons> meshes =
      lower_extension(path) == ".ply" ? std::vector{read_ply_file(path)} : read_with_assimp(path);
  Scene scene{.file = path, .title = path.stem().string(), .metres_per_unit = metres_per_unit};
  scene.materials.push_back(default_material(scene.bands));
  if (materials == MeshMaterials::from_file) {
    scene.notes.emplace_back(
        "The file has no materials; every surface gets a diffuse reflectance of 0.5.");
  }
  FilePolygons found;
  for (std::size_t m = 0; m < meshes.size(); ++m) {
    PolygonMesh mesh = read_mesh(path, meshes[m], metres_per_unit,
                                 materials == MeshMaterials::with_uv, fronts, found);
    if (mesh.facets.empty()) continue;
    const std::string stem = path.stem().string();
    scene.surfaces.push_back({.name = meshes.size() == 1 ? stem : fmt::format("{} {}", stem, m + 1),
                              .shape = std::move(mesh)});
  }
  if (scene.surfaces.empty()) fail_without_area(path, found.repairs);
  note_repairs(found.repairs, scene);
  if (polygons) *polygons = std::move(found);
  validate(scene);
  return scene;
}

Scene read_geometry(const std::filesystem::path& path, double metres_per_unit) {
  return read_geometry_file(path, metres_per_unit, MeshMaterials::from_file);
}

}  // namespace lightwell
