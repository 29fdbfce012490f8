#include <fmt/format.h>

#include <assimp/scene.h>

#include "scene/errors.h"
#include "scene/io/default_material.h"
#include "scene/io/interchange/imported_file.h"
#include "scene/io/interchange/interchange_lights.h"
#include "scene/io/interchange/interchange_materials.h"
#include "scene/io/mesh_file.h"
#include "scene/io/numbered_names.h"
#include "scene/io/placed_mesh.h"
#include "scene/io/read_scene.h"
#include "scene/io/remarks.h"
#include "scene/io/scene_size.h"

namespace lightwell {
namespace {

// Polygons of a mesh before their placement.
struct ImportedLoops {
  std::vector<Loop> loops{};
  std::vector<UvLoop> uv{};           ///< one for each loop, or empty
  std::vector<NormalLoop> normals{};  ///< one for each loop, or empty
};

class InterchangeReader {
 public:
  InterchangeReader(const ImportedFile& file, double scale, MeshMaterials wanted, Scene& scene)
      : file_(file),
        scale_(scale),
        wanted_(wanted),
        scene_(scene),
        materials_(file, scene, remarks_) {}

  void read_surfaces() {
    if (wanted_ != MeshMaterials::from_file) {
      scene_.materials.push_back(default_material(scene_.bands));
    }
    for (const ImportedNode& place : file_.nodes()) {
      for (unsigned i = 0; i < place.node->mNumMeshes; ++i) {
        const unsigned number = place.node->mMeshes[i];
        if (number >= file_.scene().mNumMeshes) continue;
        remarks_.attempt("Meshes that cannot be read were left out", place.name,
                         [&] { add_mesh(*file_.scene().mMeshes[number], place); });
      }
    }
    if (file_.scene().mNumAnimations > 0) {
      remarks_.add("Animations were left out; all stands where the file's nodes put it",
                   scene_.title);
    }
    if (scene_.surfaces.empty()) {
      fail_without_surfaces(scene_.file, "the scene has no polygons with an area", remarks_);
    }
  }

  void read_lights_and_cameras() {
    add_interchange_lights(file_, scene_, remarks_);
    add_interchange_cameras(file_, scene_, remarks_);
  }

  void remark_lights() {
    for (unsigned i = 0; i < file_.scene().mNumLights; ++i) {
      remarks_.add("Lights of mesh files were left out", file_.scene().mLights[i]->mName.C_Str());
    }
  }

  void finish() {
    if (wanted_ != MeshMaterials::with_uv) drop_unused_uv(scene_);
    if (wanted_ == MeshMaterials::from_file) remark_pictures_without_uv(scene_, remarks_);
    remarks_.report_to(scene_);
    note_repairs(repairs_, scene_);
  }

 private:
  void add_mesh(const aiMesh& from, const ImportedNode& place) {
    remark_unread(from, place.name);
    const ImportedLoops loops = loops_of(from, place.name);
    size_.add(triangles_of(loops.loops), [&](const std::string& sentence) {
      throw LimitError(fmt::format("{}: '{}' {}", scene_.file.string(), place.name, sentence));
    });
    const Eigen::Affine3d to_world = Eigen::Scaling(scale_) * place.to_world;
    if (!to_world.matrix().allFinite()) throw InputError("the node lies beyond all measure");
    PolygonMesh mesh =
        placed_loops(loops.loops, to_world, false, repairs_, loops.uv, loops.normals);
    if (mesh.facets.empty()) {
      remarks_.add("Meshes without area were left out", place.name);
      return;
    }
    const int material = wanted_ == MeshMaterials::from_file
                             ? materials_.of(from.mMaterialIndex, is_closed(mesh))
                             : 0;
    const std::string& of = scene_.materials[static_cast<std::size_t>(material)].name;
    const bool is_one_of_many = place.node->mNumMeshes > 1;
    scene_.surfaces.push_back(
        {.name =
             names_.unique(is_one_of_many ? fmt::format("{} ({})", place.name, of) : place.name),
         .material = material,
         .shape = std::move(mesh)});
  }

  void remark_unread(const aiMesh& mesh, const std::string& name) {
    if (mesh.HasBones()) {
      remarks_.add("Skins were left out; meshes keep their own shape", name);
    }
    if (mesh.mNumAnimMeshes > 0) remarks_.add("Morph targets were left out", name);
    if (mesh.HasVertexColors(0)) remarks_.add("Colours at vertices were left out", name);
  }

  ImportedLoops loops_of(const aiMesh& mesh, const std::string& name) {
    const int uv_set =
        wanted_ == MeshMaterials::from_file ? materials_.uv_set(mesh.mMaterialIndex) : 0;
    const bool has_uv = uv_set >= 0 && mesh.HasTextureCoords(static_cast<unsigned>(uv_set));
    ImportedLoops result;
    for (unsigned f = 0; f < mesh.mNumFaces; ++f) {
      const aiFace& face = mesh.mFaces[f];
      if (face.mNumIndices < 3) {
        remarks_.add("Points and lines were left out", name);
        continue;
      }
      Loop& loop = result.loops.emplace_back();
      UvLoop* uv = has_uv ? &result.uv.emplace_back() : nullptr;
      NormalLoop* normals = mesh.HasNormals() ? &result.normals.emplace_back() : nullptr;
      for (unsigned i = 0; i < face.mNumIndices; ++i) {
        const unsigned v = face.mIndices[i];
        loop.push_back(vector_of(mesh.mVertices[v]));
        // The files count v from the picture's bottom.
        const aiVector3D* coordinates = uv ? mesh.mTextureCoords[uv_set] + v : nullptr;
        if (uv) uv->emplace_back(coordinates->x, 1.0 - static_cast<double>(coordinates->y));
        if (normals) normals->push_back(vector_of(mesh.mNormals[v]));
      }
      if (const auto corner = placeless_corner(loop)) {
        repairs_.drop_placeless(fmt::format("{}: mesh '{}': vertex {} is not finite",
                                            scene_.file.string(), name, face.mIndices[*corner]));
        result.loops.pop_back();
        if (uv) result.uv.pop_back();
        if (normals) result.normals.pop_back();
      }
    }
    return result;
  }

  const ImportedFile& file_;
  double scale_;
  MeshMaterials wanted_;
  Scene& scene_;
  Remarks remarks_;
  InterchangeMaterials materials_;
  Repairs repairs_;
  NumberedNames names_;
  SceneSize size_;
};

}  // namespace

Scene read_interchange_file(const std::filesystem::path& path, double units_per_metre,
                            MeshMaterials materials) {
  const ImportedFile file(path);
  Scene scene{.file = path, .title = path.stem().string()};
  InterchangeReader reader(file, units_per_metre, materials, scene);
  reader.read_surfaces();
  reader.remark_lights();
  reader.finish();
  validate(scene);
  return scene;
}

Scene read_interchange(const std::filesystem::path& path) {
  const ImportedFile file(path);
  Scene scene{.file = path,
              .title = path.stem().string(),
              .metres_per_unit = file.metres_per_unit(),
              .relative_units = true};
  scene.notes.emplace_back(
      "Emission was read as relative: COLLADA and FBX files name no unit of light.");
  InterchangeReader reader(file, 1.0, MeshMaterials::from_file, scene);
  reader.read_surfaces();
  reader.read_lights_and_cameras();
  reader.finish();
  note_if_dark(scene);
  validate(scene);
  return scene;
}

}  // namespace lightwell
