#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <set>

#include "scene/io/corner_maps.h"
#include "scene/io/gltf/gltf_camera.h"
#include "scene/io/gltf/gltf_file.h"
#include "scene/io/gltf/gltf_geometry.h"
#include "scene/io/gltf/gltf_light.h"
#include "scene/io/gltf/gltf_materials.h"
#include "scene/io/mesh_builder.h"
#include "scene/io/numbered_names.h"
#include "scene/io/placed_mesh.h"
#include "scene/io/polygon.h"
#include "scene/io/polygon_repair.h"
#include "scene/io/read_scene.h"
#include "scene/io/remarks.h"
#include "scene/io/scene_size.h"

namespace lightwell {
namespace {

// Extensions that are read, or that do not affect the light.
constexpr std::array known_extensions = {"KHR_materials_emissive_strength",
                                         "KHR_materials_transmission",
                                         "KHR_materials_diffuse_transmission",
                                         "KHR_materials_specular",
                                         "KHR_materials_clearcoat",
                                         "KHR_materials_ior",
                                         "KHR_materials_volume",
                                         "KHR_materials_pbrSpecularGlossiness",
                                         "KHR_materials_unlit",
                                         "KHR_lights_punctual",
                                         "KHR_mesh_quantization",
                                         "KHR_draco_mesh_compression",
                                         "EXT_meshopt_compression",
                                         "KHR_texture_transform"};

// Modes of primitives (glTF 2.0, 3.7.2.1).
constexpr std::size_t triangle_list = 4, triangle_strip = 5, triangle_fan = 6;

Eigen::Affine3d local_transform(const JsonObject& node) {
  Eigen::Affine3d result = Eigen::Affine3d::Identity();
  if (const auto matrix = node.numbers("matrix", 16); !matrix.empty()) {
    result.matrix() = Eigen::Map<const Eigen::Matrix4d>(matrix.data());  // by columns, as in glTF
  } else {
    const auto t = node.numbers("translation", 3);
    const auto r = node.numbers("rotation", 4);
    const auto s = node.numbers("scale", 3);
    if (!t.empty()) result.translate(Eigen::Vector3d(t[0], t[1], t[2]));
    if (!r.empty()) {
      const Eigen::Quaterniond turn(r[3], r[0], r[1], r[2]);
      if (!(turn.norm() > 0.0)) node.fail("has a rotation without length");
      result.rotate(turn.normalized());
    }
    if (!s.empty()) result.scale(Eigen::Vector3d(s[0], s[1], s[2]));
  }
  if (!result.matrix().allFinite() || result.matrix().row(3) != Eigen::RowVector4d(0, 0, 0, 1)) {
    node.fail("has a matrix that is not finite and affine");
  }
  return result;
}

// Vertex positions of triangle `i` in a list, a strip or a fan.
std::array<std::size_t, 3> corners_of(std::size_t mode, std::size_t i) {
  if (mode == triangle_strip) return {i, i + 1 + i % 2, i + 2 - i % 2};
  if (mode == triangle_fan) return {i + 1, i + 2, 0};
  return {3 * i, 3 * i + 1, 3 * i + 2};
}

class GltfReader {
 public:
  GltfReader(const GltfFile& file, Scene& scene)
      : file_(file), scene_(scene), materials_(file, scene, remarks_) {}

  void read() {
    check_extensions();
    if (const auto punctual = file_.root().extension("KHR_lights_punctual")) {
      lights_ = punctual->objects("lights");
    }
    for (const std::size_t root : roots()) visit(root);
    for (std::size_t i = 0; i < lights_.size(); ++i) {
      if (placed_lights_.contains(i)) continue;
      remarks_.mention("Lights that no node places (KHR_lights_punctual) are not used",
                       lights_[i].name());
    }
    for (const JsonObject& animation : file_.root().objects("animations")) {
      remarks_.add("Animations were left out; all stands where the file's nodes put it",
                   animation.name());
    }
    drop_unused_uv(scene_);
    remark_pictures_without_uv(scene_, remarks_);
    if (scene_.surfaces.empty()) {
      fail_without_surfaces(scene_.file, "the scene has no triangles with an area", remarks_);
    }
    remarks_.report_to(scene_);
    note_repairs(repairs_, scene_);
  }

 private:
  struct Placed {
    std::size_t node = 0;
    Eigen::Affine3d parent = Eigen::Affine3d::Identity();
  };

  void check_extensions() {
    for (const std::string& name : file_.root().strings("extensionsUsed")) {
      if (std::ranges::find(known_extensions, name) == known_extensions.end()) {
        remarks_.add("Extensions that have no effect", name);
      }
    }
  }

  // Root nodes of the default scene; without scenes, the nodes that are no node's children.
  std::vector<std::size_t> roots() const {
    const JsonObject& root = file_.root();
    if (file_.count("scenes") > 0) {
      return file_.at("scenes", root.index_or("scene", 0), root).indices("nodes");
    }
    std::vector<char> is_child(file_.count("nodes"), 0);
    for (std::size_t i = 0; i < is_child.size(); ++i) {
      const JsonObject& node = file_.at("nodes", i, root);
      for (const std::size_t child : node.indices("children")) {
        file_.at("nodes", child, node);
        is_child[child] = 1;
      }
    }
    std::vector<std::size_t> result;
    for (std::size_t i = 0; i < is_child.size(); ++i) {
      if (!is_child[i]) result.push_back(i);
    }
    return result;
  }

  void visit(std::size_t root) {
    std::vector<Placed> open = {{.node = root}};
    while (!open.empty()) {
      const Placed placed = open.back();
      open.pop_back();
      remarks_.attempt("Nodes that cannot be used were left out, with their children",
                       fmt::format("nodes[{}]", placed.node), [&] { visit(placed, open); });
    }
  }

  void visit(const Placed& placed, std::vector<Placed>& open) {
    const JsonObject& node = file_.at("nodes", placed.node, file_.root());
    if (!seen_.insert(placed.node).second) {
      node.fail("has two parents or is its own descendant; nodes must form a tree");
    }
    const Eigen::Affine3d to_world = placed.parent * local_transform(node);
    if (!to_world.matrix().allFinite()) node.fail("lies beyond all measure");
    remarks_.attempt("Meshes that cannot be read were left out", node.name(),
                     [&] { add_mesh(node, to_world); });
    remarks_.attempt("Cameras that cannot be used were left out", node.name(), [&] {
      if (const auto camera = node.index("camera")) {
        add_gltf_camera(file_.at("cameras", *camera, node), node, to_world, scene_, remarks_);
      }
    });
    remarks_.attempt("Lights that cannot be used were left out", node.name(),
                     [&] { add_light(node, to_world); });
    // Pushed backwards, since the stack returns the last one first.
    const auto children = node.indices("children");
    for (auto child = children.rbegin(); child != children.rend(); ++child) {
      open.push_back({.node = *child, .parent = to_world});
    }
  }

  void add_light(const JsonObject& node, const Eigen::Affine3d& to_world) {
    const auto punctual = node.extension("KHR_lights_punctual");
    if (!punctual) return;
    const auto light = punctual->index("light");
    if (!light || *light >= lights_.size()) {
      node.fail(fmt::format("names a light that is none of the file's {}", lights_.size()));
    }
    placed_lights_.insert(*light);
    add_gltf_light(lights_[*light], node, to_world, scene_, remarks_);
  }

  void add_mesh(const JsonObject& node, const Eigen::Affine3d& to_world) {
    const auto index = node.index("mesh");
    if (!index) return;
    const JsonObject& mesh = file_.at("meshes", *index, node);
    const std::string name = node.has("name") ? node.name() : mesh.name();
    if (node.has("skin")) remarks_.add("Skins were left out; meshes keep their own shape", name);
    const auto primitives = mesh.objects("primitives");
    for (const JsonObject& primitive : primitives) {
      if (primitive.has("targets")) remarks_.add("Morph targets were left out", name);
      remarks_.attempt("Meshes that cannot be read were left out", primitive.place(),
                       [&] { add_primitive(primitive, to_world, name, primitives.size() > 1); });
    }
  }

  void add_primitive(const JsonObject& primitive, const Eigen::Affine3d& to_world,
                     const std::string& name, bool is_one_of_many) {
    if (primitive.index_or("mode", triangle_list) < triangle_list) {
      remarks_.add("Points and lines were left out", name);
      return;
    }
    const auto attributes = primitive.object("attributes");
    if (!attributes) primitive.fail("lacks 'attributes'");
    if (attributes->has("COLOR_0")) remarks_.add("Colours at vertices were left out", name);
    PolygonMesh mesh = read_triangles(primitive, *attributes, to_world);
    if (mesh.facets.empty()) {
      remarks_.add("Meshes without area were left out", name);
      return;
    }
    const int material = materials_.of_primitive(primitive, is_closed(mesh));
    const std::string& of = scene_.materials[static_cast<std::size_t>(material)].name;
    scene_.surfaces.push_back(
        {.name = names_.unique(is_one_of_many ? fmt::format("{} ({})", name, of) : name),
         .material = material,
         .shape = std::move(mesh)});
  }

  PolygonMesh read_triangles(const JsonObject& primitive, const JsonObject& attributes,
                             const Eigen::Affine3d& to_world) {
    const auto count_in = [&](std::int64_t triangles) {
      size_.add(triangles, [&](const std::string& sentence) {
        throw LimitError(
            fmt::format("{}: {} {}", scene_.file.string(), primitive.place(), sentence));
      });
    };
    const bool is_packed = primitive.extension("KHR_draco_mesh_compression").has_value();
    GltfGeometry geometry = read_geometry(file_, primitive, attributes,
                                          materials_.texture_coordinates(primitive), count_in);
    for (Eigen::Vector3d& p : geometry.positions) p = to_world * p;
    const Eigen::Matrix3d turn = normal_transform(to_world);
    for (Eigen::Vector3d& n : geometry.normals) n = turn * n;
    const std::size_t corners = geometry.corners();
    // Draco packs the triangles of strips and fans too as a list.
    const std::size_t mode = is_packed ? triangle_list : primitive.index_or("mode", triangle_list);
    if (mode > triangle_fan) primitive.fail(fmt::format("has the mode {}, which is none", mode));
    if (mode == triangle_list && corners % 3 != 0) {
      primitive.fail(fmt::format("has {} corners, which is no multiple of three", corners));
    }
    const std::size_t count = mode == triangle_list ? corners / 3 : corners < 3 ? 0 : corners - 2;
    if (!is_packed) count_in(static_cast<std::int64_t>(count));
    const bool is_mirrored = to_world.linear().determinant() < 0.0;
    const int placeless_before = repairs_.placeless;
    MeshBuilder mesh;
    for (std::size_t i = 0; i < count; ++i) {
      Loop loop;
      UvLoop of_loop;
      NormalLoop normals_there;
      for (const std::size_t corner : corners_of(mode, i)) {
        const std::size_t vertex = geometry.vertex(corner);
        loop.push_back(geometry.positions[vertex]);
        if (!geometry.uv.empty()) of_loop.push_back(geometry.uv[vertex]);
        if (!geometry.normals.empty()) normals_there.push_back(geometry.normals[vertex]);
      }
      if (const auto corner = placeless_corner(loop)) {
        repairs_.drop_placeless(
            fmt::format("{}: vertex {} of {} has a coordinate that is not a finite number",
                        scene_.file.string(), geometry.vertex(corners_of(mode, i)[*corner]),
                        primitive.place()));
        continue;
      }
      if (is_mirrored) {  // mirroring must not exchange front and back
        std::swap(loop[1], loop[2]);
        if (!of_loop.empty()) std::swap(of_loop[1], of_loop[2]);
        if (!normals_there.empty()) std::swap(normals_there[1], normals_there[2]);
      }
      add_repaired(mesh, std::move(loop), repairs_, std::move(of_loop), std::move(normals_there));
    }
    if (mesh.empty() && repairs_.placeless > placeless_before) {
      primitive.fail("has no triangle with an area and finite coordinates");
    }
    return mesh.mesh();
  }

  const GltfFile& file_;
  Scene& scene_;
  Remarks remarks_;
  GltfMaterials materials_;
  Repairs repairs_;
  std::vector<JsonObject> lights_{};
  std::set<std::size_t> placed_lights_{};
  std::set<std::size_t> seen_;
  NumberedNames names_;
  SceneSize size_;
};

}  // namespace

Scene read_gltf(const std::filesystem::path& path) {
  const GltfFile file(path);
  Scene scene{.file = path, .title = path.stem().string(), .relative_units = true};
  scene.notes.emplace_back(
      "Emission was read as relative: glTF files seldom mean a unit of light.");
  GltfReader(file, scene).read();
  note_if_dark(scene);
  validate(scene);
  return scene;
}

}  // namespace lightwell
