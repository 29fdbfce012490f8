#include "scene/io/mitsuba/mitsuba_shapes.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "scene/errors.h"
#include "scene/io/mitsuba/mitsuba_serialized.h"
#include "scene/io/mitsuba/mitsuba_transform.h"
#include "scene/io/placed_mesh.h"
#include "scene/io/round_facets.h"
#include "scene/io/text_file.h"
#include "scene/rotation_between.h"

namespace lightwell {
namespace {

const char* const without_area = "Shapes without area were left out";

bool is_mesh(const MitsubaNode& shape) {
  return shape.type == "obj" || shape.type == "ply" || shape.type == "serialized";
}

double positive(const MitsubaNode& shape, const char* property, double otherwise) {
  const double value = shape.number_or(property, otherwise);
  if (!(value > 0.0))
    shape.fail(fmt::format("has the {} {}; it must be positive", property, value));
  return value;
}

Eigen::Vector3d point_or(const MitsubaNode& shape, const char* property,
                         const Eigen::Vector3d& otherwise) {
  const MitsubaNode* node = shape.property(property);
  return node ? read_mitsuba_point(*node) : otherwise;
}

// Joins all surfaces of a file: a shape has one material, whatever groups its file has.
PolygonMesh joined(Scene&& scene) {
  PolygonMesh all = std::get<PolygonMesh>(std::move(scene.surfaces.front().shape));
  for (std::size_t s = 1; s < scene.surfaces.size(); ++s) {
    auto& next = std::get<PolygonMesh>(scene.surfaces[s].shape);
    const int offset = static_cast<int>(all.vertices.size());
    const int uv_offset = static_cast<int>(all.uv_maps.size());
    all.uv_maps.insert(all.uv_maps.end(), next.uv_maps.begin(), next.uv_maps.end());
    const int normal_offset = static_cast<int>(all.normal_maps.size());
    all.normal_maps.insert(all.normal_maps.end(), next.normal_maps.begin(), next.normal_maps.end());
    all.vertices.insert(all.vertices.end(), next.vertices.begin(), next.vertices.end());
    for (Facet& facet : next.facets) {
      for (int& v : facet.boundary) v += offset;
      if (facet.uv_map >= 0) facet.uv_map += uv_offset;
      if (facet.normal_map >= 0) facet.normal_map += normal_offset;
      all.facets.push_back(std::move(facet));
    }
  }
  return all;
}

}  // namespace

void MitsubaShapes::add(const MitsubaNode& shape) {
  if (shape.type == "shapegroup") return;  // visible through its instances only
  if (shape.type == "instance") return add_instance(shape);
  add_placed(shape, read_to_world(shape), "");
}

void MitsubaShapes::add_instance(const MitsubaNode& instance) {
  const auto groups = tree_.children(instance, "shape");
  if (groups.size() != 1 || groups.front()->type != "shapegroup") {
    instance.fail("needs exactly one reference to a shape of type 'shapegroup'");
  }
  const Eigen::Affine3d to_world = read_to_world(instance);
  const std::string prefix = unique_name(instance, "") + "/";
  for (const MitsubaNode* shape : tree_.children(*groups.front(), "shape")) {
    if (shape->type == "instance" || shape->type == "shapegroup") {
      remarks_.add("Instances within a group of shapes were left out", shape->label());
      continue;
    }
    remarks_.attempt("<shape> elements that cannot be used were left out", shape->label(),
                     [&] { add_placed(*shape, to_world * read_to_world(*shape), prefix); });
  }
}

void MitsubaShapes::account(const MitsubaNode& shape, std::int64_t triangles) {
  size_.add(triangles,
            [&](const std::string& sentence) { throw LimitError(shape.called(sentence)); });
}

void MitsubaShapes::add_placed(const MitsubaNode& shape, const Eigen::Affine3d& to_world,
                               const std::string& prefix) {
  const std::string name = unique_name(shape, prefix);
  const bool flip = shape.boolean_or("flip_normals", false);
  const auto loops = [&](const std::vector<Loop>& local) {
    account(shape, triangles_of(local));
    return placed_loops(local, to_world, flip, repairs_);
  };
  if (shape.type == "rectangle") {
    const std::vector<UvLoop> uv = {{{0, 0}, {1, 0}, {1, 1}, {0, 1}}};
    account(shape, 2);
    return add_surface(shape, name, placed_loops(rectangle_loops(), to_world, flip, repairs_, uv));
  }
  if (shape.type == "cube") return add_surface(shape, name, loops(cube_loops()));
  if (shape.type == "disk") {
    const Frustum unit = frustum_about({0, 0, 0}, Eigen::Vector3d::UnitZ(), 0.0, 1.0, 0.0, flip);
    return add_surface(shape, name, round(shape, unit, to_world, name));
  }
  if (shape.type == "sphere") return add_surface(shape, name, sphere(shape, to_world, name));
  if (shape.type == "cylinder") {
    return add_surface(shape, name, round(shape, cylinder(shape), to_world, name));
  }
  if (is_mesh(shape)) return add_mesh(shape, to_world, name);
  remarks_.add(fmt::format("Shapes of the plugin '{}' were left out", shape.type), name);
}

void MitsubaShapes::add_surface(const MitsubaNode& shape, const std::string& name,
                                SurfaceShape placed) {
  for (const MitsubaNode& child : shape.children) {
    const std::string& tag = child.tag;
    if (tag == "medium" || tag == "subsurface" || tag == "sensor") {
      remarks_.add(fmt::format("<{}> of a shape has no effect", tag), name);
    }
  }
  if (const auto* polygons = std::get_if<PolygonMesh>(&placed)) {
    if (polygons->facets.empty()) {
      remarks_.add(without_area, name);
      return;
    }
  }
  const int material = materials_.of_shape(shape, name);
  scene_.surfaces.push_back({.name = name, .material = material, .shape = std::move(placed)});
}

SurfaceShape MitsubaShapes::sphere(const MitsubaNode& shape, const Eigen::Affine3d& to_world,
                                   const std::string& name) {
  const Eigen::Vector3d center = point_or(shape, "center", Eigen::Vector3d::Zero());
  const double radius = positive(shape, "radius", 1.0);
  const bool flip = shape.boolean_or("flip_normals", false);
  if (!flip && keeps_angles(to_world)) {
    const double scale = std::cbrt(std::abs(to_world.linear().determinant()));
    return Sphere{.center = to_world * center, .radius = scale * radius};
  }
  remarks_.add("Spheres that are turned inside out or no longer round became polygons", name);
  const Eigen::Affine3d place = to_world * Eigen::Translation3d(center) * Eigen::Scaling(radius);
  const std::vector<Loop> loops = sphere_loops();
  account(shape, triangles_of(loops));
  // The corners of a unit sphere about the origin are its normals.
  return placed_loops(loops, place, flip, repairs_, {}, loops);
}

Frustum MitsubaShapes::cylinder(const MitsubaNode& shape) {
  const Eigen::Vector3d p0 = point_or(shape, "p0", Eigen::Vector3d::Zero());
  const Eigen::Vector3d axis = point_or(shape, "p1", Eigen::Vector3d::UnitZ()) - p0;
  const double radius = positive(shape, "radius", 1.0);
  if (!(axis.stableNorm() > 0.0)) shape.fail("has no length: p0 and p1 are one point");
  return frustum_about(p0, axis, axis.stableNorm(), radius, radius,
                       shape.boolean_or("flip_normals", false));
}

SurfaceShape MitsubaShapes::round(const MitsubaNode& shape, const Frustum& frustum,
                                  const Eigen::Affine3d& to_world, const std::string& name) {
  if (keeps_angles(to_world)) {
    account(shape, 1);
    return placed_frustum(frustum, to_world);
  }
  remarks_.add("Cylinders and disks that are no longer round became polygons of 32 corners around",
               name);
  account(shape, 2 * round_sides);
  return placed_mesh(facets_of(frustum), to_world, false, true, repairs_);
}

void MitsubaShapes::add_mesh(const MitsubaNode& shape, const Eigen::Affine3d& to_world,
                             const std::string& name) {
  const std::string file = shape.string_or("filename", "");
  if (!file.empty() && !tree_.has_file(*shape.property("filename"), file)) {
    return remarks_.add("Mesh files are missing, and their shapes were left out", file);
  }
  try {
    add_surface(shape, name, mesh(shape, to_world, name));
  } catch (const NoAreaError&) {
    remarks_.add(without_area, name);
  }
}

PolygonMesh MitsubaShapes::mesh(const MitsubaNode& shape, const Eigen::Affine3d& to_world,
                                const std::string& name) {
  // Mitsuba defines the front by the shading normals, except with face_normals. Where both sides of
  // a material are alike, the winding of the file is kept, so that its faults can be reported.
  const Material& material =
      scene_.materials[static_cast<std::size_t>(materials_.of_shape(shape, name))];
  const bool sides_differ =
      material.one_sided || material.dielectric.has_value() || material.is_emitter();
  const bool by_normals = sides_differ && !shape.boolean_or("face_normals", false);
  const bool with_uv = material.shows_picture();
  const MeshFile& file =
      mesh_file(shape, with_uv, by_normals ? MeshFronts::from_normals : MeshFronts::from_winding);
  account(shape, file.triangles);
  repairs_.add(file.repairs);
  PolygonMesh placed = placed_mesh(file.mesh, to_world, shape.boolean_or("flip_normals", false),
                                   file.has_normals, repairs_);
  if (shape.boolean_or("face_normals", false)) drop_normals(placed);
  // v points up in OBJ files unless the shape overrides that convention.
  if (shape.boolean_or("flip_tex_coords", shape.type == "obj")) return placed;
  for (UvMap& map : placed.uv_maps) {
    map.gradient.row(1) = -map.gradient.row(1);
    map.offset[1] = 1.0 - map.offset[1];
  }
  return placed;
}

const MitsubaShapes::MeshFile& MitsubaShapes::mesh_file(const MitsubaNode& shape, bool with_uv,
                                                        MeshFronts fronts) {
  const MitsubaNode* given = shape.property("filename");
  if (!given) shape.fail("lacks the property 'filename'");
  const auto path = tree_.file_named(*given, shape.string_or("filename", ""));
  const double index = shape.number_or("shape_index", 0.0);
  constexpr double most = 1e9;
  if (!(index >= 0.0 && index <= most)) shape.fail(fmt::format("has no shape_index {:g}", index));
  const auto number = static_cast<int>(index);
  const auto known = files_.find({path, number, with_uv, fronts});
  if (known != files_.end()) return known->second;
  const std::string extension = "." + shape.type;
  if (lower_extension(path) != extension) {
    given->fail(fmt::format("is '{}'; a shape of type '{}' is read from {} files", path.string(),
                            shape.type, extension));
  }
  FilePolygons polygons;
  Scene scene;
  try {
    const auto wanted = with_uv ? MeshMaterials::with_uv : MeshMaterials::ignored;
    if (shape.type == "serialized") {
      scene = read_serialized_file(path, number, wanted, polygons, fronts);
    } else if (shape.type == "obj") {
      scene = read_obj_file(path, 1.0, wanted, &polygons, fronts);
    } else {
      scene = read_geometry_file(path, 1.0, wanted, &polygons, fronts);
    }
  } catch (const NoAreaError&) {
    throw;
  } catch (const LimitError&) {
    throw;
  } catch (const InputError& error) {
    given->fail(fmt::format("cannot be used: {}", error.what()));
  }
  MeshFile file{.mesh = joined(std::move(scene)),
                .repairs = polygons.repairs,
                .has_normals = polygons.has_normals};
  file.triangles = triangles_of(file.mesh);
  return files_.emplace(std::tuple(path, number, with_uv, fronts), std::move(file)).first->second;
}

// Unique name of a surface: the shape's id if given, else its file or plugin.
std::string MitsubaShapes::unique_name(const MitsubaNode& shape, const std::string& prefix) {
  const std::string file = is_mesh(shape) ? shape.string_or("filename", "") : "";
  const std::string stem = std::filesystem::path(file).stem().string();
  return names_.unique(prefix + (!shape.id.empty() ? shape.id : !stem.empty() ? stem : shape.type));
}

}  // namespace lightwell
