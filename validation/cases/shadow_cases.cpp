#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "mesh/discontinuity/critical_lines.h"
#include "mesh/geometry/cross.h"
#include "mesh/geometry/uncovered_length.h"
#include "validation/cases/case_lists.h"
#include "validation/cases/case_scenes.h"
#include "validation/cases/reference_data.h"

namespace lightwell {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

// The polygon, turned so that it faces down.
std::vector<Vector3d> facing_down(std::vector<Vector3d> polygon) {
  const Vector3d normal = (polygon[1] - polygon[0]).cross(polygon[2] - polygon[1]);
  if (normal.z() > 0.0) std::reverse(polygon.begin(), polygon.end());
  return polygon;
}

// The blocker of the penumbra cases: all of x < 0 at this height.
std::vector<Vector3d> half_plane(double z) {
  constexpr double far = 100.0;
  return {{-far, -far, z}, {0, -far, z}, {0, far, z}, {-far, far, z}};
}

// Irradiance and exitance are floats, 6e-8 each, and kernels sum a dozen terms.
constexpr double float_share = 2e-6;

ComparedValues penumbra(const ReferenceValue& c) {
  const ReferenceValue& g = c.at("geometry");
  const double M = g.at("exitance"), y = g.at("line_y");
  Scene scene;
  add_case_polygon(scene, "emitter", add_paint(scene, {.exitance = static_cast<float>(M)}),
                   facing_down(reference_polygon(g.at("emitter"))));
  add_case_polygon(scene, "blocker", add_paint(scene, {}), half_plane(1.0));
  const LitCase lit(std::move(scene));
  ComparedValues values;
  for (const ReferenceValue& row : c.at("expected")) {
    const double x = row.at(0), E = row.at(1), unoccluded = row.at(2);
    values.push_back({fmt::format("x = {:.4f} m", x), E, lit.direct({x, y, 0}, Vector3d::UnitZ()),
                      float_share * unoccluded});
  }
  return values;
}

ComparedValues shadow_of_point(const ReferenceValue& c) {
  Scene scene;
  add_case_polygon(scene, "blocker", add_paint(scene, {}), half_plane(1.0));
  scene.lamps.push_back(
      {.name = "lamp", .position = {0, 0, 2}, .intensity = constant_spectrum(scene.bands, 100.0f)});
  const LitCase lit(std::move(scene));
  ComparedValues values;
  for (const ReferenceValue& row : c.at("expected")) {
    const double x = row.at(0), E = row.at(1);
    values.push_back({fmt::format("x = {:g} m", x), E, lit.direct({x, 0, 0}, Vector3d::UnitZ()),
                      float_share * E});
  }
  return values;
}

// A scene of an emitter, a blocker and the receiver, its facet 2, whose plane has the coordinates
// `x` and `y`.
struct ShadowScene {
  Scene scene{};
  int receiver = 0;  // facet
  int x = 0, y = 1;
  Vector3d up = Vector3d::UnitZ();
  double size = 1.0;  // m, of coordinates
};

ShadowScene flat_shadow_scene(const ReferenceValue& g) {
  ShadowScene s{.receiver = 2};
  add_case_polygon(s.scene, "emitter", add_paint(s.scene, {.exitance = 1.0f}),
                   facing_down(reference_polygon(g.at("emitter"))));
  const int black = add_paint(s.scene, {}), grey = add_paint(s.scene, {.reflectance = 0.5f});
  add_case_polygon(s.scene, "blocker", black, reference_polygon(g.at("blocker")));
  add_case_polygon(s.scene, "receiver", grey, {{-4, -4, 0}, {4, -4, 0}, {4, 4, 0}, {-4, 4, 0}});
  return s;
}

// The tall block of the Cornell box on a floor large enough for all of its shadow, mm.
ShadowScene block_shadow_scene(const ReferenceValue& g) {
  ShadowScene s{.receiver = 1, .x = 0, .y = 2, .up = Vector3d::UnitY(), .size = 1000.0};
  std::vector<Vector3d> light = reference_polygon(g.at("light"));
  const Vector3d normal = (light[1] - light[0]).cross(light[2] - light[1]);
  if (normal.y() > 0.0) std::reverse(light.begin(), light.end());
  add_case_polygon(s.scene, "light", add_paint(s.scene, {.exitance = 1.0f}), light);
  const int black = add_paint(s.scene, {}), grey = add_paint(s.scene, {.reflectance = 0.5f});
  constexpr double far = 3000.0;
  add_case_polygon(s.scene, "floor", grey,
                   {{-far, 0, -far}, {-far, 0, far}, {far, 0, far}, {far, 0, -far}});
  const double height = g.at("block_height");
  std::vector<Vector3d> base, top;
  for (const ReferenceValue& corner : g.at("block_base")) {
    base.emplace_back(corner.at(0).get<double>(), 0.0, corner.at(1).get<double>());
    top.push_back(base.back() + height * Vector3d::UnitY());
  }
  add_case_polygon(s.scene, "top", black, top);
  for (std::size_t i = 0; i < base.size(); ++i) {
    const std::size_t next = (i + 1) % base.size();
    add_case_polygon(s.scene, "side", black, {base[i], base[next], top[next], top[i]});
  }
  return s;
}

struct FlatLine {
  Vector2d a, b;
};

// Length of `line` that no line of `cover` lies on, m.
double length_without(const FlatLine& line, const std::vector<FlatLine>& cover, double tolerance) {
  const Vector2d d = line.b - line.a;
  const double length = d.norm();
  if (length == 0.0) return 0.0;
  std::vector<std::pair<double, double>> parts;
  for (const FlatLine& other : cover) {
    const bool is_beside = std::abs(cross(d, other.a - line.a)) > tolerance * length ||
                           std::abs(cross(d, other.b - line.a)) > tolerance * length;
    if (is_beside) continue;
    const double s = d.dot(other.a - line.a) / length, t = d.dot(other.b - line.a) / length;
    parts.emplace_back(std::min(s, t), std::max(s, t));
  }
  return uncovered_length(length, std::move(parts));
}

// The outlines of umbra and penumbra are critical lines.
void add_outlines(const ReferenceValue& expected, const ShadowScene& s, ComparedValues& values) {
  std::vector<FlatLine> found;
  for (const CriticalLine& line : critical_lines(s.scene).lines) {
    if (line.facet != s.receiver) continue;
    const auto flat = [&s](const Vector3d& p) { return Vector2d(p[s.x], p[s.y]); };
    found.push_back({flat(line.ends[0]), flat(line.ends[1])});
  }
  const double tolerance = 1e-9 * s.size;
  const auto add = [&](const char* name, const ReferenceValue& polygon) {
    if (polygon.empty()) return;  // the light leaves no umbra
    double missing = 0.0;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
      const ReferenceValue &a = polygon.at(i), &b = polygon.at((i + 1) % polygon.size());
      missing += length_without({{a.at(0).get<double>(), a.at(1).get<double>()},
                                 {b.at(0).get<double>(), b.at(1).get<double>()}},
                                found, tolerance);
    }
    values.push_back({fmt::format("outline of the {} without a critical line", name), 0.0, missing,
                      1e-6 * s.size});
  };
  const bool is_block = expected.contains("penumbra_outer_unclipped");
  add("penumbra", expected.at(is_block ? "penumbra_outer_unclipped" : "penumbra_outer"));
  add("umbra", expected.at(is_block ? "umbra_unclipped_including_base" : "umbra"));
}

ComparedValues shadow_on_receiver(const ReferenceValue& c) {
  const ReferenceValue& g = c.at("geometry");
  ShadowScene s = g.contains("light") ? block_shadow_scene(g) : flat_shadow_scene(g);
  ComparedValues values;
  add_outlines(c.at("expected"), s, values);
  const int x = s.x, y = s.y;
  const Vector3d up = s.up;
  const LitCase lit(std::move(s.scene));
  for (const ReferenceValue& row : c.at("irradiance_grid").at("rows")) {
    if (row.at(3).is_null()) continue;  // under the block
    Vector3d point = Vector3d::Zero();
    point[x] = row.at(0);
    point[y] = row.at(1);
    const double unoccluded = row.at(2), F = row.at(3);
    values.push_back({fmt::format("({:.4g}, {:.4g})", point[x], point[y]), F, lit.direct(point, up),
                      float_share * unoccluded});
  }
  return values;
}

ComparedValues shadow_of(const ReferenceValue& c) {
  const std::string id = c.at("id");
  if (id == "point-shadow") return shadow_of_point(c);
  return c.at("kind") == "soft-shadow" ? penumbra(c) : shadow_on_receiver(c);
}

}  // namespace

std::vector<ValidationCase> shadow_cases() {
  std::vector<ValidationCase> cases;
  for (const ReferenceValue& c : reference_cases(validation_data::optics_json)) {
    if (c.at("kind") == "optics") continue;
    const bool has_lines = c.at("kind") == "discontinuity";
    cases.push_back(
        {.id = c.at("id"),
         .group = "shadows",
         .title = c.at("title"),
         .source = c.at("formula"),
         .reason = std::string("2e-6 of the unoccluded value: floats in exact visibility") +
                   (has_lines ? "; 1e-6 of the scene's size of missing outline" : ""),
         .has_plot = true,
         .compute = [c](const Progress&) { return shadow_of(c); }});
  }
  return cases;
}

}  // namespace lightwell
