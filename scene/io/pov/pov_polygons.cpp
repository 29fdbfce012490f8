#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <map>
#include <utility>

#include "scene/io/convex_cut.h"
#include "scene/io/pov/pov_solids.h"

namespace lightwell {
namespace {

/// Loops of a list of points, in which each loop ends with its first point.
std::vector<Loop> loops_of(const Loop& points) {
  std::vector<Loop> loops;
  Loop open;
  for (const Eigen::Vector3d& p : points) {
    if (open.size() > 2 && p == open.front()) {
      loops.push_back(std::exchange(open, {}));
    } else if (open.empty() || p != open.back()) {
      open.push_back(p);
    }
  }
  if (open.size() > 2) loops.push_back(std::move(open));
  return loops;
}

/// True if a point of the plane of `loop` lies within (number of crossings).
bool holds(const Loop& loop, const Eigen::Vector3d& point) {
  const Eigen::Vector3d normal = area_vector(loop);
  Eigen::Index across = 0;
  normal.cwiseAbs().maxCoeff(&across);
  const Eigen::Index a = (across + 1) % 3, b = (across + 2) % 3;
  bool is_within = false;
  for (std::size_t i = 0; i < loop.size(); ++i) {
    const Eigen::Vector3d& p = loop[i];
    const Eigen::Vector3d& q = loop[(i + 1) % loop.size()];
    if ((p[b] > point[b]) == (q[b] > point[b])) continue;
    if (point[a] < p[a] + (point[b] - p[b]) / (q[b] - p[b]) * (q[a] - p[a])) is_within = !is_within;
  }
  return is_within;
}

/// Loops by the rule that each loop within another turns inside into outside.
std::vector<Polygon> polygons_of(const std::vector<Loop>& loops, const PovNode& node) {
  constexpr std::size_t most = 200;
  if (loops.size() > most) {
    node.fail(fmt::format("has {} loops; at most {} are read", loops.size(), most));
  }
  std::vector<int> around(loops.size(), 0);
  std::vector<std::size_t> parent(loops.size(), loops.size());
  for (std::size_t i = 0; i < loops.size(); ++i) {
    for (std::size_t k = 0; k < loops.size(); ++k) {
      if (i != k && holds(loops[k], loops[i].front())) ++around[i];
    }
  }
  for (std::size_t i = 0; i < loops.size(); ++i) {
    for (std::size_t k = 0; k < loops.size(); ++k) {
      if (i != k && around[k] == around[i] - 1 && holds(loops[k], loops[i].front())) parent[i] = k;
    }
  }
  std::map<std::size_t, Polygon> polygons;
  for (std::size_t i = 0; i < loops.size(); ++i) {
    if (around[i] % 2 == 0) polygons[i].boundary = loops[i];
  }
  for (std::size_t i = 0; i < loops.size(); ++i) {
    if (around[i] % 2 == 0 || parent[i] == loops.size()) continue;
    Loop hole = loops[i];
    Polygon& outer = polygons[parent[i]];
    if (outer.boundary.empty()) continue;
    if (area_vector(hole).dot(area_vector(outer.boundary)) > 0.0) std::ranges::reverse(hole);
    outer.holes.push_back(std::move(hole));
  }
  std::vector<Polygon> result;
  for (auto& [number, polygon] : polygons) {
    if (!polygon.boundary.empty()) result.push_back(std::move(polygon));
  }
  return result;
}

void add_polygon(Polygon polygon, PovFacets& facets) {
  if (polygon.holes.empty()) {
    facets.loops.push_back(std::move(polygon.boundary));
  } else {
    facets.polygons.push_back(std::move(polygon));
  }
}

Loop read_points(PovCursor& cursor) {
  const std::size_t count = cursor.need_count("number of points");
  Loop points;
  for (std::size_t i = 0; i < count; ++i) points.push_back(cursor.need_point("points"));
  return points;
}

/// The polygon at the height y, whose front is above if `is_top`.
Polygon at_height(Polygon polygon, double y, bool is_top) {
  const auto place = [&](Loop& loop, bool is_reversed) {
    for (Eigen::Vector3d& p : loop) p.y() = y;
    if (is_reversed) std::ranges::reverse(loop);
  };
  const bool is_turned = (area_vector(polygon.boundary).y() > 0.0) != is_top;
  place(polygon.boundary, is_turned);
  for (Loop& hole : polygon.holes) place(hole, is_turned);
  return polygon;
}

}  // namespace

PovSolid read_pov_polygon(PovCursor& cursor) {
  PovFacets facets;
  for (Polygon& polygon : polygons_of(loops_of(read_points(cursor)), cursor.node())) {
    add_polygon(std::move(polygon), facets);
  }
  PovSolid solid{.is_closed = false};
  if (!facets.loops.empty() || !facets.polygons.empty()) {
    solid.pieces.push_back({.shape = std::move(facets)});
  }
  return solid;
}

PovSolid read_pov_prism(PovCursor& cursor) {
  for (const char* kind : {"conic_sweep", "quadratic_spline", "cubic_spline", "bezier_spline"}) {
    if (cursor.take(kind)) {
      cursor.node().fail(
          fmt::format("is a {}; only linear splines in a linear sweep are read", kind));
    }
  }
  while (cursor.take("linear_sweep") || cursor.take("linear_spline")) continue;
  const double first = cursor.need_number("first height"),
               second = cursor.need_number("second height");
  const double low = std::min(first, second), high = std::max(first, second);
  Loop points = read_points(cursor);
  for (Eigen::Vector3d& p : points) p = {p.x(), 0.0, p.y()};  // u and v are x and z
  const bool is_open = cursor.take("open");
  PovSolid solid{.is_closed = !is_open};
  if (!(high > low)) return solid;
  PovFacets facets;
  for (const Polygon& polygon : polygons_of(loops_of(points), cursor.node())) {
    const Polygon base = at_height(polygon, low, false);
    const auto add_sides = [&](const Loop& loop) {
      for (std::size_t i = 0; i < loop.size(); ++i) {
        const Eigen::Vector3d &p = loop[i], &q = loop[(i + 1) % loop.size()];
        facets.loops.push_back({q, p, {p.x(), high, p.z()}, {q.x(), high, q.z()}});
      }
    };
    add_sides(base.boundary);
    for (const Loop& hole : base.holes) add_sides(hole);
    if (is_open) continue;
    add_polygon(at_height(polygon, high, true), facets);
    add_polygon(base, facets);
  }
  if (!facets.loops.empty()) solid.pieces.push_back({.shape = std::move(facets)});
  return solid;
}

PovSolid read_pov_triangle(PovCursor& cursor) {
  const bool is_smooth = cursor.node().keyword == "smooth_triangle";
  PovFacets facets{.loops = {{}}};
  if (is_smooth) facets.normals.emplace_back();
  for (int i = 0; i < 3; ++i) {
    facets.loops[0].push_back(cursor.need_point("corners"));
    if (is_smooth) facets.normals[0].push_back(cursor.need_point("normals"));
  }
  if (cursor.take("uv_vectors")) {
    facets.uv.emplace_back();
    for (int i = 0; i < 3; ++i) {
      const Eigen::Vector3d uv = cursor.need_point("uv_vectors");
      facets.uv[0].emplace_back(uv.x(), 1.0 - uv.y());
    }
  }
  PovSolid solid{.is_closed = false};
  solid.pieces.push_back({.shape = std::move(facets)});
  return solid;
}

// Triangles of one texture become one piece.
PovSolid read_pov_mesh(PovCursor& cursor) {
  std::vector<std::pair<const PovNode*, PovFacets>> by_texture;
  while (const PovNode* triangle = cursor.look() ? cursor.look()->node() : nullptr) {
    if (triangle->keyword != "triangle" && triangle->keyword != "smooth_triangle") break;
    cursor.next();
    PovCursor within(*triangle);
    PovSolid one = read_pov_triangle(within);
    const PovNode* texture = within.block();
    if (texture && texture->keyword != "texture") texture = nullptr;
    auto found = std::ranges::find(by_texture, texture, &decltype(by_texture)::value_type::first);
    constexpr std::size_t most_textures = 1000;
    if (found == by_texture.end() && by_texture.size() >= most_textures) {
      triangle->fail(fmt::format("has a texture beyond the first {} of its mesh", most_textures));
    }
    if (found == by_texture.end()) {
      by_texture.emplace_back(texture, PovFacets());
      found = by_texture.end() - 1;
    }
    PovFacets& all = found->second;
    const auto& facets = std::get<PovFacets>(one.pieces[0].shape);
    all.loops.push_back(facets.loops[0]);
    all.normals.push_back(facets.normals.empty() ? NormalLoop() : facets.normals[0]);
    all.uv.push_back(facets.uv.empty() ? UvLoop() : facets.uv[0]);
  }
  PovSolid solid{.is_closed = false};
  for (auto& [texture, facets] : by_texture) {
    solid.pieces.push_back({.shape = std::move(facets), .texture = texture});
  }
  return solid;
}

}  // namespace lightwell
