#include "scene/io/toml/toml_surfaces.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "scene/errors.h"
#include "scene/io/corner_maps.h"
#include "scene/io/mesh_builder.h"
#include "scene/io/mesh_file.h"
#include "scene/io/nearest_name.h"
#include "scene/io/numbered_names.h"
#include "scene/io/placed_mesh.h"
#include "scene/io/polygon.h"
#include "scene/io/polygon_repair.h"
#include "scene/io/remarks.h"
#include "scene/io/round_facets.h"
#include "scene/io/text_file.h"
#include "scene/io/toml/toml_motions.h"
#include "scene/io/toml/toml_placement.h"

namespace lightwell {
namespace {

constexpr std::initializer_list<const char*> shape_keys = {"polygon",  "polygons", "box",  "sphere",
                                                           "cylinder", "cone",     "disc", "mesh"};

// True for meshes of formats that name their unit of length, and bring materials.
bool has_unit(std::string_view extension) {
  return extension == ".dae" || extension == ".fbx";
}

Loop read_loop(const TomlValue& value, const Placement& place) {
  Loop loop;
  for (const auto& vertex : value.elements("vertex")) loop.push_back(place(vertex.vector()));
  return loop;
}

}  // namespace

// Builds the surface of one [[surfaces]] table.
class TomlSurfaces::Reader {
 public:
  Reader(const TomlValue& value, const TomlTable& table, std::string name, TomlSurfaces& all)
      : value_(value),
        table_(table),
        name_(std::move(name)),
        all_(all),
        scene_(all.scene_),
        place_(read_placement(table, scene_.metres_per_unit)) {
    if (const auto motion = table.find("motion")) motion_ = find_toml_motion(*motion, scene_);
  }

  void read() {
    const auto shapes = table_.present(shape_keys);
    if (shapes.size() != 1) {
      table_.fail(
          shapes.empty()
              ? "has no shape; give one of " + quoted_list({shape_keys.begin(), shape_keys.end()})
              : fmt::format("has both '{}' and '{}'; give one shape only", shapes[0], shapes[1]));
    }
    const std::string& shape = shapes[0];
    const TomlValue given = table_.require(shape);
    if (const auto holes = table_.find("holes"); holes && shape != "polygon") {
      holes->fail(fmt::format("belongs to 'polygon', but the shape is '{}'", shape));
    }
    if (const auto flip = table_.find("flip"); flip && shape != "mesh") {
      flip->fail(fmt::format("belongs to 'mesh', but the shape is '{}'", shape));
    }
    if (const auto smooth = table_.find("smooth"); smooth && shape != "mesh") {
      smooth->fail(fmt::format("belongs to 'mesh', but the shape is '{}'", shape));
    }
    if (const auto uv = table_.find("uv"); uv && shape != "polygon" && shape != "polygons") {
      uv->fail(fmt::format(
          "belongs to 'polygon' and 'polygons', but the shape is '{}'; mesh files bring their own",
          shape));
    }
    if (shape == "mesh") return read_mesh(given);
    const int material = find_material(table_.require("material"));
    if (shape == "sphere") return add_surface(name_, material, read_sphere(given));
    if (shape == "cylinder") return add_surface(name_, material, read_cylinder(given));
    if (shape == "cone") return add_surface(name_, material, read_cone(given));
    if (shape == "disc") return add_surface(name_, material, read_disc(given));
    MeshBuilder mesh;
    if (shape == "polygon") add_polygon(given, mesh);
    if (shape == "polygons") add_polygons(given, mesh);
    if (shape == "box") add_box(given, mesh);
    note_bent();
    note_faulty();
    if (mesh.empty()) return;
    add_surface(name_, material, mesh.mesh());
  }

 private:
  int find_material(const TomlValue& value) const {
    const std::string name = value.name();
    if (const int found = all_.material_of(name); found >= 0) return found;
    std::vector<std::string> known;
    for (const Material& m : scene_.materials) known.push_back(m.name);
    value.fail(fmt::format("is '{}', which is not among the materials of this file.{}", name,
                           did_you_mean(name, known)));
  }

  bool shows_picture(int material) const {
    return scene_.materials[static_cast<std::size_t>(material)].shows_picture();
  }

  void add_surface(const std::string& name, int material, SurfaceShape shape) {
    if (!all_.names_.insert(name).second) {
      value_.fail("has a name that an earlier surface has; give it another");
    }
    scene_.surfaces.push_back(
        {.name = name, .material = material, .shape = std::move(shape), .motion = motion_});
  }

  Sphere read_sphere(const TomlValue& value) const {
    const TomlTable t = value.table({"center", "radius"});
    return {.center = place_(t.require("center").vector()),
            .radius = place_.scale * t.require("radius").positive()};
  }

  static double at_least_0(const TomlValue& value) {
    const double number = value.number();
    if (!(number >= 0.0)) value.fail(fmt::format("is {}; it must be at least 0", number));
    return number;
  }

  // A frustum between the points `from` and `to` of a table.
  Frustum frustum_of(const TomlTable& t, double radius, double top_radius) const {
    const Eigen::Vector3d from = place_(t.require("from").vector());
    const Eigen::Vector3d axis = place_(t.require("to").vector()) - from;
    if (!(axis.norm() > 0.0)) t.fail("has one point as 'from' and 'to'; give it a length");
    const auto inward = t.find("inward");
    return frustum_about(from, axis, axis.norm(), place_.scale * radius, place_.scale * top_radius,
                         inward && inward->boolean());
  }

  Frustum read_cylinder(const TomlValue& value) const {
    const TomlTable t = value.table({"from", "to", "radius", "inward"});
    const double radius = t.require("radius").positive();
    return frustum_of(t, radius, radius);
  }

  Frustum read_cone(const TomlValue& value) const {
    const TomlTable t = value.table({"from", "to", "radius", "top_radius", "inward"});
    const auto top = t.find("top_radius");
    return frustum_of(t, t.require("radius").positive(), top ? at_least_0(*top) : 0.0);
  }

  Frustum read_disc(const TomlValue& value) const {
    const TomlTable t = value.table({"center", "normal", "radius", "inner_radius"});
    const Eigen::Vector3d normal = t.require("normal").vector();
    if (!(normal.norm() > 0.0)) t.require("normal").fail("is 0; give a direction");
    const double radius = t.require("radius").positive();
    const auto inner = t.find("inner_radius");
    const double hole = inner ? at_least_0(*inner) : 0.0;
    // A thinner ring counts as one without area, as a thinner polygon does.
    if (!(radius - hole > flatness * radius)) {
      inner->fail(fmt::format("is {}; it must be less than the radius {}", hole, radius));
    }
    return frustum_about(place_(t.require("center").vector()), place_.rotation * normal, 0.0,
                         place_.scale * radius, place_.scale * hole, false);
  }

  void add_polygon(const TomlValue& value, MeshBuilder& mesh) {
    Polygon polygon{.boundary = read_loop(value, place_)};
    if (const auto holes = table_.find("holes")) {
      for (const auto& hole : holes->elements("hole")) {
        polygon.holes.push_back(read_loop(hole, place_));
      }
    }
    const auto uv = table_.find("uv");
    add_sound(value, polygon, uv ? read_uv(*uv, polygon.boundary.size()) : UvLoop{}, mesh);
  }

  static UvLoop read_uv(const TomlValue& value, std::size_t corners) {
    UvLoop uv;
    for (const auto& corner : value.elements("corner")) {
      const auto numbers = corner.elements("number");
      if (numbers.size() != 2) corner.fail("must be two numbers [u, v]");
      uv.emplace_back(numbers[0].number(), numbers[1].number());
    }
    if (uv.size() != corners) {
      value.fail(fmt::format("has {} places for a polygon of {} vertices; give one each", uv.size(),
                             corners));
    }
    return uv;
  }

  void add_polygons(const TomlValue& value, MeshBuilder& mesh) {
    const auto polygons = value.elements("polygon");
    if (polygons.empty()) value.fail("is empty; give at least one polygon");
    const auto uv = table_.find("uv");
    const auto places = uv ? uv->elements("polygon") : std::vector<TomlValue>{};
    if (uv && places.size() != polygons.size()) {
      uv->fail(fmt::format("is of {} polygons, but there are {}", places.size(), polygons.size()));
    }
    for (std::size_t i = 0; i < polygons.size(); ++i) {
      const Polygon polygon{.boundary = read_loop(polygons[i], place_)};
      const UvLoop of_loop = uv ? read_uv(places[i], polygon.boundary.size()) : UvLoop{};
      add_sound(polygons[i], polygon, of_loop, mesh);
    }
  }

  void add_sound(const TomlValue& value, const Polygon& polygon, const UvLoop& uv,
                 MeshBuilder& mesh) {
    if (const std::string what = fault(polygon); !what.empty()) {
      return add_faulty(value, polygon, uv, what, mesh);
    }
    const double deviation = deviation_from_plane(polygon);
    const bool is_planar = deviation <= flatness;
    const bool is_even = uv.empty() || uv_map_over(polygon.boundary, uv);
    if (is_planar && is_even) return mesh.add(polygon, uv);
    if (is_planar && !polygon.holes.empty()) {
      value.fail(
          "has holes and texture coordinates that are not linear over it; give a 'uv' that "
          "is, or cut it into pieces");
    }
    const double distance = deviation * size_of(polygon.boundary) / scene_.metres_per_unit;
    if (!polygon.holes.empty()) {
      value.fail(
          fmt::format("is not planar (a vertex is {:.3g} {} off) and has holes; make it "
                      "planar or cut it into planar pieces",
                      distance, scene_.unit_name));
    }
    const auto triangles = split_into_triangles(polygon.boundary);
    if (triangles.empty()) value.fail("cannot be split into triangles");
    for (const auto& t : triangles) {
      const Polygon corners{
          .boundary = {polygon.boundary[t[0]], polygon.boundary[t[1]], polygon.boundary[t[2]]}};
      if (const std::string what = fault(corners); !what.empty()) {
        value.fail("is not planar, and when split into triangles it has one that " + what);
      }
      mesh.add(corners, uv.empty() ? uv : UvLoop{uv[t[0]], uv[t[1]], uv[t[2]]});
    }
    if (is_planar) return;
    if (bent_++ == 0) first_bent_ = value.what();
    made_of_bent_ += triangles.size();
    farthest_ = std::max(farthest_, distance);
  }

  // Adds all that a polygon with a fault goes round, without its holes; nothing without an area.
  void add_faulty(const TomlValue& value, const Polygon& polygon, UvLoop uv,
                  const std::string& what, MeshBuilder& mesh) {
    const auto is_short = [](const Loop& loop) { return loop.size() < 3; };
    if (is_short(polygon.boundary) || std::ranges::any_of(polygon.holes, is_short))
      value.fail(what);
    if (!uv.empty() && !polygon.holes.empty()) {
      const auto map = uv_map_over(polygon.boundary, uv);
      if (!map) value.fail(what);
      for (const Loop& hole : polygon.holes) {
        for (const Eigen::Vector3d& corner : hole) uv.push_back(map->at(corner));
      }
    }
    Faults& faults = add_pieces(mesh, polygon, uv) ? cut_ : left_out_;
    if (faults.count++ == 0) faults.first = value.located(what);
  }

  // Adds a loss for all polygons of the surface with a fault that were cut into pieces, and one for
  // all that were left out.
  void note_faulty() const {
    const auto note = [&](const Faults& faults, const char* one, const char* more) {
      if (faults.count == 0) return;
      const std::string others =
          faults.count == 1 ? "" : fmt::format(", and {} more of the surface", faults.count - 1);
      add_loss(scene_,
               fmt::format("{}; it{} {}.", faults.first, others, faults.count == 1 ? one : more));
    };
    note(cut_, "was cut into pieces that do not overlap",
         "were cut into pieces that do not overlap");
    note(left_out_, "was left out", "were left out");
  }

  // Adds one note for all polygons of the surface that were split.
  void note_bent() const {
    if (bent_ == 0) return;
    scene_.notes.push_back(
        bent_ == 1
            ? fmt::format("{} is not planar (a vertex is {:.3g} {} off its plane) and was split "
                          "into {} triangles.",
                          first_bent_, farthest_, scene_.unit_name, made_of_bent_)
            : fmt::format("{} polygons of surface '{}' are not planar (a vertex is up to {:.3g} {} "
                          "off its plane) and were split into {} triangles.",
                          bent_, name_, farthest_, scene_.unit_name, made_of_bent_));
  }

  void add_box(const TomlValue& value, MeshBuilder& mesh) const {
    const TomlTable t = value.table({"min", "max", "inward"});
    const Eigen::Vector3d low = t.require("min").vector(), high = t.require("max").vector();
    for (int c = 0; c < 3; ++c) {
      if (!(low[c] < high[c])) {
        value.fail(fmt::format("has {0} from {1} to {2}; max must be greater than min", "xyz"[c],
                               low[c], high[c]));
      }
    }
    const auto inward = t.find("inward");
    const bool turned = inward && inward->boolean();
    // Bits of a corner's number: x, y, z at max.
    constexpr std::array<std::array<int, 4>, 6> faces = {
        {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}}};
    for (const auto& face : faces) {
      Polygon polygon;
      for (int corner : face) {
        polygon.boundary.push_back(
            place_({(corner & 1 ? high : low).x(), (corner & 2 ? high : low).y(),
                    (corner & 4 ? high : low).z()}));
      }
      if (const std::string what = fault(polygon); !what.empty()) {
        value.fail("has a face that " + what);
      }
      if (turned) std::reverse(polygon.boundary.begin(), polygon.boundary.end());
      mesh.add(polygon);
    }
  }

  void read_mesh(const TomlValue& value) {
    const std::string name = value.name();
    const std::string extension = lower_extension(name);
    const bool has_materials = extension == ".obj" || has_unit(extension);
    if (!has_materials && extension != ".ply" && extension != ".stl") {
      value.fail(fmt::format("is '{}'; a mesh is an .obj, .ply, .stl, .dae or .fbx file", name));
    }
    const auto path = (value.file().parent_path() / name).lexically_normal();
    const auto material = table_.find("material");
    if (!material && !has_materials) {
      value.fail(fmt::format("has no materials in '{}'; add a 'material' to the surface", name));
    }
    const auto flip = table_.find("flip");
    const bool turned = flip && flip->boolean();
    const auto smooth = table_.find("smooth");
    const bool is_smooth = !smooth || smooth->boolean();
    Scene mesh;
    try {
      const auto wanted = !material                                 ? MeshMaterials::from_file
                          : shows_picture(find_material(*material)) ? MeshMaterials::with_uv
                                                                    : MeshMaterials::ignored;
      mesh = all_.mesh_of(path, wanted);
    } catch (const InputError& error) {
      value.fail(fmt::format("cannot be used: {}", error.what()));
    }
    for (const Surface& surface : mesh.surfaces) {
      all_.size_.add(triangles_of(std::get<PolygonMesh>(surface.shape)),
                     [&](const std::string& sentence) { value_.fail(sentence); });
    }
    for (const std::string& note : mesh.notes) {
      scene_.notes.push_back(fmt::format("{}: {}", name_, note));
    }
    for (const std::string& loss : mesh.losses) {
      scene_.losses.push_back(fmt::format("{}: {}", name_, loss));
    }
    scene_.dropped_polygons += mesh.dropped_polygons;
    for (Surface& surface : mesh.surfaces) {
      auto& polygons = std::get<PolygonMesh>(surface.shape);
      for (auto& vertex : polygons.vertices) vertex = place_(vertex);
      for (auto& map : polygons.uv_maps) map = place_(map);
      for (auto& map : polygons.normal_maps) map = place_(map);
      if (!is_smooth) drop_normals(polygons);
      if (turned) turn_over(polygons);
      const auto& own = mesh.materials[static_cast<std::size_t>(surface.material)];
      add_surface(mesh.surfaces.size() == 1 ? name_ : fmt::format("{}/{}", name_, surface.name),
                  material ? find_material(*material) : import_material(own, name, value),
                  std::move(surface.shape));
    }
  }

  // A material of the scene with the same name takes precedence. Two files may use one name for
  // different materials, hence the qualified name.
  int import_material(Material material, const std::string& file, const TomlValue& value) {
    const std::string qualified = fmt::format("{} ({})", material.name, file);
    for (const std::string& known : {material.name, qualified}) {
      if (const int found = all_.material_of(known); found >= 0) return found;
    }
    if (!scene_.bands.wavelengths_nm.empty()) {
      value.fail(
          fmt::format("brings the RGB material '{}' into a scene with {} spectral bands; add "
                      "[materials.{}] or give the surface a 'material'",
                      material.name, scene_.bands.count(), material.name));
    }
    material.name = qualified;
    return all_.add_material(std::move(material));
  }

  const TomlValue& value_;
  const TomlTable& table_;
  std::string name_;
  TomlSurfaces& all_;
  Scene& scene_;
  Placement place_;
  int bent_ = 0;  // polygons that were not planar
  std::size_t made_of_bent_ = 0;
  std::string first_bent_{};
  double farthest_ = 0.0;  // of their vertices off the plane, in the file's unit
  struct Faults {
    int count = 0;
    std::string first{};
  };
  Faults cut_{}, left_out_{};
  int motion_ = -1;
};

TomlSurfaces::TomlSurfaces(Scene& scene) : scene_(scene) {
  for (std::size_t i = 0; i < scene.materials.size(); ++i) {
    materials_.emplace(scene.materials[i].name, static_cast<int>(i));
  }
}

int TomlSurfaces::material_of(const std::string& name) const {
  const auto found = materials_.find(name);
  return found == materials_.end() ? -1 : found->second;
}

int TomlSurfaces::add_material(Material material) {
  const int index = static_cast<int>(scene_.materials.size());
  materials_.emplace(material.name, index);
  scene_.materials.push_back(std::move(material));
  return index;
}

Scene TomlSurfaces::mesh_of(const std::filesystem::path& path, MeshMaterials wanted) {
  const auto known = meshes_.find({path, wanted});
  if (known != meshes_.end()) return known->second;
  const std::string extension = lower_extension(path);
  const auto is_replaced = [&](const std::string& material) { return material_of(material) >= 0; };
  Scene mesh = has_unit(extension)
                   ? read_interchange_file(path, 1.0 / scene_.metres_per_unit, wanted)
               : extension != ".obj"                ? read_geometry_file(path, 1.0, wanted)
               : wanted == MeshMaterials::from_file ? read_obj_part(path, 1.0, is_replaced)
                                                    : read_obj_file(path, 1.0, wanted);
  constexpr std::size_t small = 10'000;  // facets; larger meshes soon reach the limit of SceneSize
  if (scene_facets(mesh).size() <= small) meshes_.emplace(std::pair(path, wanted), mesh);
  return mesh;
}

void TomlSurfaces::add(const TomlValue& value, std::size_t number) {
  const auto given = value.member("name");
  const std::string name = given ? given->name() : fmt::format("surface{}", number);
  if (name != shortened(name)) given->fail("is very long; 250 characters are enough");
  const TomlValue named = value.renamed(fmt::format("surface '{}'", name));
  const TomlTable table = named.table(
      {"name", "material", "polygon", "holes", "polygons", "box", "sphere", "cylinder", "cone",
       "disc", "mesh", "flip", "smooth", "scale", "rotate", "pivot", "translate", "uv", "motion"});
  Reader(named, table, name, *this).read();
}

}  // namespace lightwell
