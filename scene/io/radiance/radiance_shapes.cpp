#include "scene/io/radiance/radiance_shapes.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cctype>
#include <cmath>

#include "scene/io/placed_mesh.h"
#include "scene/io/round_facets.h"
#include "scene/io/seams.h"
#include "scene/limits.h"
#include "scene/rotation_between.h"

namespace lightwell {
namespace {

constexpr std::int64_t most_primitives = 2'000'000;
constexpr std::size_t most_corners =
    2000;  // of a polygon; with more, it is a curve that strips show better

// Name without a last number: "box" of "box.12".
std::string stem_of(const std::string& name) {
  const std::size_t dot = name.rfind('.');
  if (dot == std::string::npos || dot == 0 || dot + 1 == name.size()) return name;
  const bool is_number = std::all_of(name.begin() + static_cast<std::ptrdiff_t>(dot) + 1,
                                     name.end(), [](unsigned char c) { return std::isdigit(c); });
  return is_number ? name.substr(0, dot) : name;
}

// Bounds the numbers, so that nothing overflows before Scene's own check.
void require_moderate(const RadiancePrimitive& p) {
  for (const double value : p.reals) {
    if (!(std::abs(value) <= farthest_coordinate)) {
      p.fail(fmt::format("reaches {:g}; nothing may lie beyond {:g}", value, farthest_coordinate));
    }
  }
}

}  // namespace

void RadianceShapes::add(const RadiancePrimitive& p) {
  if (++primitives_ > most_primitives) {
    p.location.fail_limit(
        fmt::format("{} '{}' is primitive {} of the scene; at most {} are read, use fewer copies",
                    p.type, p.name, primitives_, most_primitives));
  }
  if (p.kind() != RadianceKind::surface) return materials_.define(p);
  if (p.type == "source") return add_source(p);
  require_moderate(p);
  const bool is_lamp = add_lamp(p);
  const auto material = is_lamp ? materials_.behind_illum(p) : materials_.of_surface(p);
  if (!material) return;
  if (p.type == "polygon") return add_polygon(p, *material);
  complete_surface();
  if (p.type == "sphere" || p.type == "bubble") return add_sphere(p, *material);
  if (p.type == "ring") return add_ring(p, *material);
  add_cone(p, *material);
}

void RadianceShapes::add_source(const RadiancePrimitive& source) {
  auto light = materials_.light_of(source);
  if (!light) {
    return remarks_.add("Distant sources whose light is not understood were left out", source.name);
  }
  // A dark sky would still open windows of illums.
  if (is_only_seen(light->material)) return;
  sky_.add(source, std::move(*light));
}

// Adds a lamp for a surface whose light depends on direction; false for other surfaces.
bool RadianceShapes::add_lamp(const RadiancePrimitive& surface) {
  const auto light = materials_.light_of(surface);
  if (!light || !lamps_.add(surface, *light)) return false;
  if (light->material.type == "spotlight") {
    remarks_.add(
        "The light of spotlights spreads from their surface, not from the focus f behind it: at "
        "the distance d it is (1 + f/d)^2 times RADIANCE's",
        surface.name);
  }
  remarks_.mention("Luminous surfaces whose light depends on direction became lamps", surface.name);
  return true;
}

void RadianceShapes::finish(const Eigen::Vector3d& up) {
  complete_surface();
  if (sky_.is_empty()) return;
  sky_.finish(scene_, up, remarks_);
  lamps_.remove_illums();
  materials_.open_illums();
}

void RadianceShapes::complete_surface() {
  if (!mesh_.empty()) {
    scene_.surfaces.push_back(
        {.name = names_.unique(stem_), .material = material_, .shape = mesh_.mesh()});
  }
  mesh_ = {};
  stem_.clear();
  material_ = -1;
}

void RadianceShapes::account(const RadiancePrimitive& primitive, std::int64_t triangles) {
  size_.add(triangles, [&](const std::string& sentence) {
    primitive.location.fail_limit(
        fmt::format("{} '{}' {}", primitive.type, primitive.name, sentence));
  });
}

void RadianceShapes::add_polygon(const RadiancePrimitive& p, int material) {
  const std::size_t corners = p.reals.size() / 3;
  if (p.reals.size() % 3 != 0 || corners < 3) {
    p.fail(fmt::format("has {} real arguments; x, y and z of at least three corners are needed",
                       p.reals.size()));
  }
  if (corners > most_corners) {
    p.fail(fmt::format("has {} corners; at most {} are read, split it", corners, most_corners));
  }
  account(p, triangles_of(corners));
  const std::string stem = stem_of(p.name);
  if (stem != stem_ || material != material_) complete_surface();
  stem_ = stem;
  material_ = material;
  Loop loop;
  for (std::size_t i = 0; i < corners; ++i) loop.push_back(p.point(3 * i));
  loop.erase(std::unique(loop.begin(), loop.end()), loop.end());
  while (loop.size() > 1 && loop.front() == loop.back()) loop.pop_back();
  if (loop.size() > 4 && !fault({loop}).empty()) {
    const auto polygon = without_seams(loop);
    if (polygon && fault(*polygon).empty() && deviation_from_plane(*polygon) <= flatness) {
      return mesh_.add(*polygon);
    }
  }
  add_repaired(mesh_, std::move(loop), repairs_);
}

bool RadianceShapes::sides_differ(int material) const {
  const Material& m = scene_.materials[static_cast<std::size_t>(material)];
  return m.one_sided || m.dielectric.has_value() || m.is_emitter();
}

void RadianceShapes::add_surface(const RadiancePrimitive& p, int material, SurfaceShape shape) {
  if (const auto* mesh = std::get_if<PolygonMesh>(&shape)) {
    account(p, triangles_of(*mesh));
    if (mesh->facets.empty()) {
      remarks_.add("Shapes without area were left out", p.name);
      return;
    }
  }
  scene_.surfaces.push_back(
      {.name = names_.unique(p.name), .material = material, .shape = std::move(shape)});
}

// A negative radius turns a sphere inside out, as in RADIANCE.
void RadianceShapes::add_sphere(const RadiancePrimitive& p, int material) {
  p.require_reals(4);
  const double radius = std::abs(p.reals[3]);
  if (!(radius > 0.0)) return remarks_.add("Shapes without area were left out", p.name);
  const bool inward = (p.type == "bubble") != (p.reals[3] < 0.0);
  if (!inward || !sides_differ(material)) {
    return add_surface(p, material, Sphere{.center = p.point(0), .radius = radius});
  }
  remarks_.add("Bubbles whose sides differ became polygons of the same area", p.name);
  const Eigen::Affine3d transform = Eigen::Translation3d(p.point(0)) * Eigen::Scaling(radius);
  const std::vector<Loop> loops = sphere_loops();
  // The corners of a unit sphere about the origin are its normals.
  add_surface(p, material, placed_loops(loops, transform, true, repairs_, {}, loops));
}

void RadianceShapes::add_cone(const RadiancePrimitive& p, int material) {
  const bool is_cylinder = p.type == "cylinder" || p.type == "tube";
  p.require_reals(is_cylinder ? 7 : 8);
  const double first = p.reals[6], second = p.reals.back();
  if (first * second < 0.0) p.fail("has radii of different signs");
  const Eigen::Vector3d from = p.point(0), axis = p.point(3) - from;
  const double height = axis.stableNorm();
  if (!(height > 0.0) || !(std::abs(first) + std::abs(second) > 0.0)) {
    return remarks_.add("Shapes without area were left out", p.name);
  }
  const bool is_inner = p.type == "tube" || p.type == "cup";
  const bool inward = is_inner != (first < 0.0 || second < 0.0);
  account(p, 1);
  add_surface(p, material,
              frustum_about(from, axis, height, std::abs(first), std::abs(second), inward));
}

void RadianceShapes::add_ring(const RadiancePrimitive& p, int material) {
  p.require_reals(8);
  const Eigen::Vector3d normal = p.point(3);
  const double inner = std::min(p.reals[6], p.reals[7]), outer = std::max(p.reals[6], p.reals[7]);
  if (!(inner >= 0.0)) p.fail(fmt::format("has the radius {}; it must not be negative", inner));
  if (!(normal.stableNorm() > 0.0)) p.fail("has no normal: its fourth to sixth number are 0");
  // Thinner rings count as rings without area.
  if (!(outer - inner > flatness * outer)) {
    return remarks_.add("Shapes without area were left out", p.name);
  }
  account(p, 1);
  add_surface(p, material, frustum_about(p.point(0), normal, 0.0, outer, inner, false));
}

}  // namespace lightwell
