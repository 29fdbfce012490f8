#include "scene/io/pov/pov_shapes.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "scene/errors.h"
#include "scene/io/convex_cut.h"
#include "scene/io/placed_mesh.h"
#include "scene/io/pov/pov_transform.h"
#include "scene/io/round_facets.h"
#include "scene/limits.h"

namespace lightwell {
namespace {

constexpr std::array<std::string_view, 14> shapes_left_out = {
    "blob",           "isosurface",    "text",         "height_field", "julia_fractal",
    "superellipsoid", "bicubic_patch", "parametric",   "quadric",      "quartic",
    "cubic",          "poly",          "sphere_sweep", "ovus"};

constexpr std::array<std::string_view, 4> groups = {"union", "merge", "object", "light_group"};

template <class Words>
bool is_among(const Words& words, std::string_view word) {
  return std::ranges::find(words, word) != words.end();
}

const char* const without_area = "Shapes without area were left out";

void require_near(const Eigen::Vector3d& p) {
  if (p.cwiseAbs().maxCoeff() <= farthest_coordinate && p.allFinite()) return;
  throw InputError(
      fmt::format("it reaches farther than {:g} from the origin", farthest_coordinate));
}

}  // namespace

bool PovShapes::add(const PovNode& block, const PovNode* defaults, double gamma) {
  gamma_ = gamma;
  PovPlacement outer{.to_world = from_pov_axes()};
  if (defaults) outer.look.parts.push_back(defaults);
  return add_placed(block, outer);
}

bool PovShapes::add_placed(const PovNode& block, const PovPlacement& outer) {
  count_pov_visit(block, materials_.visits());
  const std::string_view word = block.keyword;
  PovPlacement named = outer;
  if (!block.name.empty()) named.name = block.name;
  PovCursor cursor(block);
  if (word == "light_source") {
    lights_.add(block, outer.to_world, named.name, gamma_, scene_, remarks_);
  } else if (word == "plane") {
    add_plane(cursor, named);
  } else if (is_among(groups, word)) {
    add_children(block, inner(cursor, named));
  } else if (word == "difference" || word == "intersection") {
    add_cut(block, named);
  } else if (is_among(shapes_left_out, word)) {
    remarks_.add(fmt::format("Shapes of the kind '{}' were left out", word), block.label());
  } else if (const auto solid = read_pov_solid(cursor, remarks_)) {
    if (named.name.empty()) named.name = word;
    add_solid(*solid, inner(cursor, named));
  } else {
    return false;
  }
  return true;
}

void PovShapes::add_part(const PovNode& part, PovPlacement& placement, bool& has_own) {
  const std::string_view word = part.keyword;
  if (word == "material") {
    for (const PovItem& item : part.items) {
      if (item.node()) add_part(*item.node(), placement, has_own);
    }
  } else if (word == "texture" || word == "pigment" || word == "finish" || word == "normal") {
    if (!has_own) {
      // Only the defaults stay of what is inherited.
      std::erase_if(placement.look.parts,
                    [](const PovNode* inherited) { return inherited->keyword != "default"; });
      placement.look.to_world = Eigen::Affine3d::Identity();
    }
    has_own = true;
    placement.look.parts.push_back(&part);
  } else if (word == "interior") {
    placement.look.interior = &part;
  } else if (word == "clipped_by") {
    remarks_.add("'clipped_by' was left out, so that whole shapes are shown",
                 part.place.file->filename().string() + fmt::format(":{}", part.place.line));
  }
}

// Transformations move the texture if they follow it, and the shape in any case.
PovPlacement PovShapes::inner(PovCursor& cursor, const PovPlacement& outer) {
  PovPlacement result = outer;
  Eigen::Affine3d all = Eigen::Affine3d::Identity();
  bool has_own = false;
  while (!cursor.at_end()) {
    Eigen::Affine3d step = Eigen::Affine3d::Identity();
    if (take_pov_transform(cursor, step)) {
      all = step * all;
      if (has_own) result.look.to_world = step * result.look.to_world;
      continue;
    }
    const PovItem& item = cursor.next();
    if (item.node()) add_part(*item.node(), result, has_own);
    if (item.word == "hollow" || item.word == "inverse") {
      result.is_hollow = cursor.number().value_or(1.0) != 0.0;
    } else if (item.word == "no_shadow") {
      remarks_.add("Shapes without shadow ('no_shadow') cast one here", result.name);
    }
  }
  result.to_world = outer.to_world * all;
  if (has_own) result.look.to_world = outer.to_world * result.look.to_world;
  return result;
}

void PovShapes::add_children(const PovNode& block, const PovPlacement& placement) {
  constexpr std::array<std::string_view, 11> parts = {
      "texture",    "pigment",    "finish",  "normal",    "interior",        "material",
      "bounded_by", "clipped_by", "photons", "transform", "interior_texture"};
  for (const PovItem& item : block.items) {
    const PovNode* child = item.node();
    if (child && !is_among(parts, child->keyword)) {
      remarks_.attempt("Shapes that cannot be used were left out", child->label(), [&] {
        if (!add_placed(*child, placement)) child->fail("is no shape that is known here");
      });
    } else if (!child && !item.word.empty() && block.keyword == "object" &&
               &item == &block.items[0]) {
      remarks_.add("Shapes that are not declared were left out", item.word);
    }
  }
}

void PovShapes::account(std::int64_t triangles, const std::string& name) {
  size_.add(triangles, [&](const std::string& sentence) {
    throw LimitError(fmt::format("'{}' {}", name, sentence));
  });
}

void PovShapes::add_solid(const PovSolid& solid, const PovPlacement& placement) {
  if (solid.pieces.empty()) return remarks_.add(without_area, placement.name);
  for (const PovPiece& piece : solid.pieces) add_piece(piece, placement, solid.is_closed);
}

void PovShapes::add_piece(const PovPiece& piece, const PovPlacement& placement, bool is_closed) {
  PovPlacement own = placement;
  if (piece.texture) {
    own.look.parts = {piece.texture};
    own.look.to_world = placement.to_world;
  }
  const std::string name = shortened(placement.name) + std::string(piece.suffix);
  SurfaceShape shape = placed(piece, own);
  auto* mesh = std::get_if<PolygonMesh>(&shape);
  if (mesh && mesh->facets.empty()) return remarks_.add(without_area, name);
  const bool is_body = is_closed || (mesh && own.look.interior && lightwell::is_closed(*mesh));
  const PovMaterial material = materials_.of(own.look, name, is_body, placement.is_hollow, gamma_);
  if (mesh && material.layout != PovMaterial::Layout::none) set_pov_layout(material, *mesh);
  add_surface(std::move(shape), material, name);
}

void PovShapes::add_surface(SurfaceShape shape, const PovMaterial& material,
                            const std::string& name) {
  scene_.surfaces.push_back({.name = names_.unique(name.empty() ? "shape" : name),
                             .material = material.number,
                             .shape = std::move(shape)});
}

SurfaceShape PovShapes::placed(const PovPiece& piece, const PovPlacement& placement) {
  const Eigen::Affine3d& to_world = placement.to_world;
  const bool is_round = keeps_angles(to_world);
  const double scale = std::cbrt(std::abs(to_world.linear().determinant()));
  if (const auto* sphere = std::get_if<Sphere>(&piece.shape)) {
    const Eigen::Vector3d center = to_world * sphere->center;
    require_near(center.cwiseAbs() + Eigen::Vector3d::Constant(scale * sphere->radius));
    account(is_round ? 1 : triangles_of(sphere_loops()), placement.name);
    if (is_round) return Sphere{.center = center, .radius = scale * sphere->radius};
    const Eigen::Affine3d place =
        to_world * Eigen::Translation3d(sphere->center) * Eigen::Scaling(sphere->radius);
    remarks_.add("Round shapes that are no longer round became polygons", placement.name);
    const std::vector<Loop> loops = sphere_loops();
    return placed_loops(loops, place, false, repairs_, {}, loops);
  }
  if (const auto* frustum = std::get_if<Frustum>(&piece.shape)) {
    const double reach = frustum->height + std::max(frustum->base_radius, frustum->top_radius);
    require_near((to_world * frustum->base).cwiseAbs() + Eigen::Vector3d::Constant(scale * reach));
    account(is_round ? 1 : 2 * round_sides, placement.name);
    if (is_round) return placed_frustum(*frustum, to_world);
    remarks_.add("Round shapes that are no longer round became polygons", placement.name);
    return placed_mesh(facets_of(*frustum), to_world, false, true, repairs_);
  }
  const auto& facets = std::get<PovFacets>(piece.shape);
  account(triangles_of(facets.loops), placement.name);
  return placed_facets(facets, to_world);
}

PolygonMesh PovShapes::placed_facets(const PovFacets& facets, const Eigen::Affine3d& to_world) {
  const auto check = [&](const Loop& loop) {
    for (const Eigen::Vector3d& p : loop) require_near(to_world * p);
  };
  std::ranges::for_each(facets.loops, check);
  if (facets.polygons.empty()) {
    return placed_loops(facets.loops, to_world, false, repairs_, facets.uv, facets.normals);
  }
  const bool is_mirrored = to_world.linear().determinant() < 0.0;
  const auto place = [&](Loop loop) {
    check(loop);
    for (Eigen::Vector3d& p : loop) p = to_world * p;
    if (is_mirrored) std::ranges::reverse(loop);
    return loop;
  };
  MeshBuilder mesh;
  for (const Loop& loop : facets.loops) add_repaired(mesh, place(loop), repairs_);
  for (const Polygon& given : facets.polygons) {
    Polygon polygon{.boundary = place(given.boundary)};
    for (const Loop& hole : given.holes) polygon.holes.push_back(place(hole));
    account(triangles_of(polygon.boundary.size()), "polygon");
    if (fault(polygon).empty() && deviation_from_plane(polygon) <= flatness) {
      mesh.add(polygon);
    } else {
      add_pieces(mesh, polygon);
    }
  }
  return mesh.mesh();
}

void PovShapes::add_plane(PovCursor& cursor, const PovPlacement& outer) {
  const Eigen::Vector3d normal = cursor.need_point("normal");
  const double distance = cursor.need_number("distance");
  if (!(normal.stableNorm() > 0.0)) cursor.node().fail("has a normal without length");
  PovPlacement placement = inner(cursor, outer);
  if (placement.name.empty()) placement.name = "plane";
  const Eigen::Affine3d& to_world = placement.to_world;
  const Eigen::Vector3d point = to_world * (distance * normal.normalized());
  const Eigen::Vector3d across = to_world.linear().inverse().transpose() * normal.normalized();
  if (!across.allFinite() || !(across.norm() > 0.0)) cursor.node().fail("is scaled to nothing");
  require_near(point);
  constexpr std::size_t most_planes = 1000;
  if (planes_.size() >= most_planes)
    cursor.node().fail("is one plane more than the scene may have");
  Plane plane{
      .half_space = {.normal = across.normalized()},
      .material = materials_.of(placement.look, placement.name, true, placement.is_hollow, gamma_),
      .name = placement.name};
  plane.half_space.distance = plane.half_space.normal.dot(point);
  const Material& material = scene_.materials[static_cast<std::size_t>(plane.material.number)];
  plane.is_opaque = !material.dielectric && !material.passes_straight();
  planes_.push_back(std::move(plane));
}

Bounds PovShapes::bounds_of_all() const {
  Eigen::AlignedBox3d box;
  if (!scene_.surfaces.empty()) {
    const Bounds of_surfaces = scene_bounds(scene_);
    box.extend(of_surfaces.low);
    box.extend(of_surfaces.high);
  }
  for (const Camera& camera : scene_.cameras) box.extend(camera.position);
  if (box.isEmpty() || !(box.diagonal().norm() > 0.0)) {
    for (const Lamp& lamp : scene_.lamps) box.extend(lamp.position);
  }
  if (box.isEmpty()) box.extend(Eigen::Vector3d(Eigen::Vector3d::Zero()));
  if (!(box.diagonal().norm() > 0.0)) {
    box.extend(Eigen::Vector3d(box.min() + Eigen::Vector3d::Ones()));
  }
  return {.low = box.min(), .high = box.max()};
}

// A square about the middle of the bounds, four times their diagonal wide.
Loop PovShapes::plane_square(const Plane& plane, const Bounds& around) const {
  const Eigen::Vector3d& normal = plane.half_space.normal;
  const Eigen::Vector3d middle = 0.5 * (around.low + around.high);
  const Eigen::Vector3d foot = middle - (normal.dot(middle) - plane.half_space.distance) * normal;
  // Edges run along the axes of the scene where the plane does.
  Eigen::Index axis = 0;
  normal.cwiseAbs().minCoeff(&axis);
  const Eigen::Vector3d along = normal.cross(Eigen::Vector3d::Unit(axis)).normalized();
  const Eigen::Vector3d beside = normal.cross(along);
  const double half = 2.0 * around.diagonal();
  return {foot - half * along - half * beside, foot + half * along - half * beside,
          foot + half * along + half * beside, foot - half * along + half * beside};
}

void PovShapes::finish() {
  const Bounds around = bounds_of_all();
  const double size = around.diagonal();
  for (const Plane& plane : planes_) {
    std::vector<Loop> parts = {plane_square(plane, around)};
    for (const Plane& other : planes_) {
      // Nothing sees what lies inside of another plane, unless a camera stands there.
      const auto sees = [&](const Camera& camera) {
        return other.half_space.normal.dot(camera.position) < other.half_space.distance;
      };
      if (&other == &plane || !other.is_opaque || std::ranges::any_of(scene_.cameras, sees))
        continue;
      std::vector<double> distance;
      for (const Eigen::Vector3d& p : parts[0]) {
        distance.push_back(other.half_space.normal.dot(p) - other.half_space.distance);
      }
      Loop left = clip_convex(parts[0], distance, 1.0);
      if (left.size() >= 3 && area_vector(left).norm() > flatness * size * size) parts[0] = left;
    }
    account(2, plane.name);
    PolygonMesh mesh = placed_loops(parts, Eigen::Affine3d::Identity(), false, repairs_);
    if (mesh.facets.empty()) continue;
    if (plane.material.layout != PovMaterial::Layout::none) set_pov_layout(plane.material, mesh);
    remarks_.add("Planes end where four times the size of all else does", plane.name);
    add_surface(std::move(mesh), plane.material, plane.name);
  }
  lights_.finish(0.5 * (around.low + around.high), scene_);
}

}  // namespace lightwell
