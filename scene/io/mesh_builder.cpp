#include "scene/io/mesh_builder.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <utility>

#include "scene/io/flat_loop.h"

namespace lightwell {
namespace {

// Largest deviation from another facet's map; suits files of four decimals.
constexpr double alike = 3e-4;

// Number of latest maps tried for a new facet: facets of one flat piece are adjacent in files.
constexpr int looked_at = 8;

}  // namespace

std::vector<int> MeshBuilder::indices(const Loop& loop) {
  std::vector<int> result;
  for (const auto& p : loop) {
    // Adding 0.0 turns -0 into 0, so that both are one position.
    const std::array<double, 3> key = {p.x() + 0.0, p.y() + 0.0, p.z() + 0.0};
    const auto [found, is_new] = index_of_.emplace(key, static_cast<int>(mesh_.vertices.size()));
    if (is_new) mesh_.vertices.push_back(p);
    result.push_back(found->second);
  }
  return result;
}

int MeshBuilder::uv_map(const Loop& loop, const UvLoop& uv) {
  if (uv.empty()) return -1;
  const int count = static_cast<int>(mesh_.uv_maps.size());
  for (int i = count - 1; i >= std::max(0, count - looked_at); --i) {
    if (agrees(mesh_.uv_maps[static_cast<std::size_t>(i)], loop, uv)) return i;
  }
  const auto map = uv_map_over(loop, uv);
  if (!map) return -1;
  mesh_.uv_maps.push_back(*map);
  return count;
}

int MeshBuilder::normal_map(const Loop& loop, const NormalLoop& normals) {
  const NormalLoop unit = bent_normals(loop, normals);
  if (unit.empty()) return -1;
  const int count = static_cast<int>(mesh_.normal_maps.size());
  for (int i = count - 1; i >= std::max(0, count - looked_at); --i) {
    if (agrees(mesh_.normal_maps[static_cast<std::size_t>(i)], loop, unit, alike)) return i;
  }
  const auto map = map_of_unit_normals(loop, unit);
  if (!map) return -1;
  mesh_.normal_maps.push_back(*map);
  return count;
}

void MeshBuilder::add(const Polygon& polygon, const UvLoop& uv, const NormalLoop& normals) {
  Facet facet{.boundary = indices(polygon.boundary),
              .uv_map = uv_map(polygon.boundary, uv),
              .normal_map = normal_map(polygon.boundary, normals)};
  const Eigen::Vector3d normal = area_vector(polygon.boundary);
  for (const Loop& hole : polygon.holes) {
    facet.holes.push_back(indices(hole));
    if (area_vector(hole).dot(normal) > 0.0)
      std::reverse(facet.holes.back().begin(), facet.holes.back().end());
  }
  mesh_.facets.push_back(std::move(facet));
}

}  // namespace lightwell
