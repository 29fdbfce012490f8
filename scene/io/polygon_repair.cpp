#include "scene/io/polygon_repair.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

#include "scene/io/crossing_polygon.h"
#include "scene/io/flat_loop.h"

namespace lightwell {

void Repairs::add(const Repairs& other) {
  split += other.split;
  thin += other.thin;
  crossing += other.crossing;
  if (placeless == 0) first_placeless = other.first_placeless;
  placeless += other.placeless;
}

void Repairs::drop_placeless(const std::string& fault) {
  if (placeless++ == 0) first_placeless = fault;
}

std::vector<std::string> Repairs::notes() const {
  std::vector<std::string> result;
  const auto add = [&](int count, const char* one, const char* many) {
    if (count > 0) result.push_back(fmt::format("{} {}", count, count == 1 ? one : many));
  };
  add(split, "polygon was not planar and was split into triangles",
      "polygons were not planar and were split into triangles");
  add(thin, "polygon without area was dropped", "polygons without area were dropped");
  add(crossing, "polygon that crosses itself was cut into pieces that do not",
      "polygons that cross themselves were cut into pieces that do not");
  add(placeless, "polygon with a vertex that has no finite coordinates was dropped",
      "polygons with vertices that have no finite coordinates were dropped");
  if (placeless > 0) {
    result.back() +=
        fmt::format("{}: {}", placeless > 1 ? "; the first such vertex" : "", first_placeless);
  }
  return result;
}

std::optional<std::size_t> placeless_corner(const Loop& loop) {
  const auto found = std::ranges::find_if(loop, [](const auto& p) { return !p.allFinite(); });
  if (found == loop.end()) return std::nullopt;
  return static_cast<std::size_t>(found - loop.begin());
}

namespace {

// Removes corners that repeat the previous corner.
void join_repeated(Loop& loop, UvLoop& uv, NormalLoop& normals) {
  std::size_t kept = 0;
  for (std::size_t i = 0; i < loop.size(); ++i) {
    if (kept > 0 && loop[i] == loop[kept - 1]) continue;
    if (!uv.empty()) uv[kept] = uv[i];
    if (!normals.empty()) normals[kept] = normals[i];
    loop[kept++] = loop[i];
  }
  while (kept > 1 && loop[0] == loop[kept - 1]) --kept;
  loop.resize(kept);
  if (!uv.empty()) uv.resize(kept);
  if (!normals.empty()) normals.resize(kept);
}

// Values of a loop's corners at the corners of a piece.
template <class Value>
std::vector<Value> values_of(const std::vector<PieceCorner>& piece,
                             const std::vector<Value>& values) {
  std::vector<Value> result;
  for (const PieceCorner& corner : piece) {
    if (!values.empty()) result.push_back(corner.of(values));
  }
  return result;
}

// True if a loop with an area can be a facet as it is.
bool is_sound(const Loop& loop, const UvLoop& uv, const NormalLoop& normals) {
  if (loop.size() > 3 && !(fault({loop}).empty() && deviation_from_plane({loop}) <= flatness)) {
    return false;
  }
  return (uv.empty() || uv_map_over(loop, uv)) && is_even(loop, normals);
}

// Adds the triangles of a loop that have an area.
void add_triangles(MeshBuilder& mesh, const Loop& loop, const UvLoop& uv, const NormalLoop& normals,
                   const std::vector<std::array<int, 3>>& triangles) {
  for (const auto& t : triangles) {
    const Loop corners = {loop[t[0]], loop[t[1]], loop[t[2]]};
    const UvLoop of_corners = uv.empty() ? uv : UvLoop{uv[t[0]], uv[t[1]], uv[t[2]]};
    const NormalLoop normals_there =
        normals.empty() ? normals : NormalLoop{normals[t[0]], normals[t[1]], normals[t[2]]};
    if (!is_thin(corners)) mesh.add({corners}, of_corners, normals_there);
  }
}

}  // namespace

bool add_pieces(MeshBuilder& mesh, const Polygon& polygon, const UvLoop& uv,
                const NormalLoop& normals) {
  Loop all = polygon.boundary;
  for (const Loop& hole : polygon.holes) all.insert(all.end(), hole.begin(), hole.end());
  const auto pieces = convex_pieces(polygon);
  double area = 0.0;
  for (const auto& piece : pieces) area += area_vector(values_of(piece, all)).norm();
  if (!has_area(area, polygon.boundary)) return false;
  for (const auto& piece : pieces) {
    const Loop corners = values_of(piece, all);
    const UvLoop of_corners = values_of(piece, uv);
    const NormalLoop normals_there = values_of(piece, normals);
    if (is_thin(corners)) continue;
    if (corners.size() == 3 || is_sound(corners, of_corners, normals_there)) {
      mesh.add({corners}, of_corners, normals_there);
    } else {
      add_triangles(mesh, corners, of_corners, normals_there, {{0, 1, 2}, {0, 2, 3}});
    }
  }
  return true;
}

void add_repaired(MeshBuilder& mesh, Loop loop, Repairs& repairs, UvLoop uv, NormalLoop normals) {
  join_repeated(loop, uv, normals);
  const bool thin = loop.size() < 3 || is_thin(loop);
  if (thin && loop.size() <= 3) {
    ++repairs.thin;
    return;
  }
  if (!thin && (loop.size() == 3 || is_sound(loop, uv, normals))) {
    return mesh.add({std::move(loop)}, uv, normals);
  }
  // Some exporters join a hole to its polygon by a bridge, an edge in both directions. Such a loop
  // is no simple polygon, but ear clipping triangulates it.
  const auto triangles = thin ? std::vector<std::array<int, 3>>{} : split_into_triangles(loop);
  if (triangles.empty()) {
    ++(add_pieces(mesh, {loop}, uv, normals) ? repairs.crossing : repairs.thin);
    return;
  }
  if (!is_sound(loop, {}, {})) ++repairs.split;
  add_triangles(mesh, loop, uv, normals, triangles);
}

void add_with_holes(MeshBuilder& mesh, Polygon polygon, Repairs& repairs) {
  if (polygon.holes.empty()) {
    add_repaired(mesh, std::move(polygon.boundary), repairs);
  } else if (fault(polygon).empty() && deviation_from_plane(polygon) <= flatness) {
    mesh.add(polygon);
  } else {
    add_pieces(mesh, polygon);
  }
}

}  // namespace lightwell
