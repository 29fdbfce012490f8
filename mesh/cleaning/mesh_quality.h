#pragma once

#include <cstdint>

#include "scene/scene.h"

namespace lightwell {

/// How well a scene's polygons are made. Edges are counted within each surface, its corners within
/// 1e-7 of the scene's diagonal being one: what belongs to two surfaces may lie edge to edge and
/// still be a boundary of both. Spheres are left out.
struct MeshQuality {
  std::int64_t triangles = 0;   ///< that the polygons amount to
  std::int64_t slivers = 0;     ///< polygons whose width is below sliver_share of their length
  std::int64_t open_edges = 0;  ///< belong to one polygon only
  std::int64_t non_manifold_edges = 0;  ///< belong to more than two
  std::int64_t inconsistent_edges =
      0;  ///< two polygons run along them the same way: one is reversed
};

inline constexpr double sliver_share = 0.01;

/// A triangle's width and length are its longest edge and the height on it; those of other polygons
/// their diameter (twice the largest distance from the mean of the corners) and their area over it.
/// Edges are compared whole: where polygons meet along a part of one, it is open.
MeshQuality mesh_quality(const Scene& scene);

}  // namespace lightwell
