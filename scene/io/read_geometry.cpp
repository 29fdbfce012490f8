#include <fmt/format.h>

#include <assimp/postprocess.h>
#include <assimp/scene.h>

#include <algorithm>
#include <assimp/Importer.hpp>
#include <cctype>
#include <fstream>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

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

// Checks a PLY header, since the reader of assimp 5.2 never returns from a truncated one, skips
// lines that it does not know, trusts any count, takes a name that begins with digits for a count,
// and writes beyond its faces for a second element of the same name.
class PlyHeader {
 public:
  explicit PlyHeader(const std::filesystem::path& path)
      : path_(path), bytes_(static_cast<double>(std::filesystem::file_size(path))) {}

  void check() {
    std::ifstream stream(path_, std::ios::binary);
    for (number_ = 1; std::getline(stream, line_); ++number_) {
      std::string_view rest = line_;
      const std::string_view key = next_word(rest);
      if (number_ == 1) {
        if (key != "ply") fail_geometry(path_, "this is no PLY file; its first line must be 'ply'");
      } else if (key == "end_header") {
        if (!stream.eof()) return;
      } else if (key == "element") {
        check_element(rest);
      } else if (key == "format" || key == "property") {
        require(std::exchange(was_format_, true) != (key == "format"),
                "the header must have one format, before its elements");
      } else {
        require(key.empty() || key == "comment" || key == "obj_info",
                "the header of a PLY file has no such line");
      }
    }
    fail_geometry(path_,
                  "the header does not end with 'end_header'; the file was damaged or cut off");
  }

 private:
  void require(bool holds, std::string_view what_is_wrong) const {
    if (holds) return;
    throw InputError(fmt::format("{}:{}: {} ({}); the file was damaged", path_.string(), number_,
                                 what_is_wrong, trimmed(line_)));
  }

  void check_element(std::string_view rest) {
    const std::string_view name = next_word(rest);
    require(!name.empty() && std::isdigit(static_cast<unsigned char>(name.front())) == 0,
            "the name of an element must begin with a letter");
    require(std::ranges::find(elements_, name) == elements_.end(),
            "an earlier element has the same name");
    elements_.emplace_back(name);
    const auto count = parse_finite(next_word(rest));
    if (!count || !(*count >= 0.0 && *count <= bytes_)) {
      throw InputError(
          fmt::format("{}:{}: the file is too short for so many of '{}' ({}); it was damaged or "
                      "cut off",
                      path_.string(), number_, name, trimmed(line_)));
    }
  }

  const std::filesystem::path& path_;
  double bytes_ = 0.0;
  int number_ = 0;
  std::string line_;
  std::vector<std::string> elements_;
  bool was_format_ = false;
};

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
  if (lower_extension(path) == ".ply") PlyHeader(path).check();
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
