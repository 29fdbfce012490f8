#pragma once

#include <cstdint>

#include "scene/scene.h"

namespace lightwell {

/// Quality of a scene's polygons, round shapes excluded. Edges are counted within each surface,
/// with corners within 1e-7 of the scene's diagonal as one: surfaces that lie edge to edge both
/// have a boundary there.
struct MeshQuality {
  std::int64_t triangles = 0;           ///< number of triangles that the polygons amount to
  std::int64_t slivers = 0;             ///< polygons of a width below sliver_share of their length
  std::int64_t open_edges = 0;          ///< edges of one polygon only
  std::int64_t non_manifold_edges = 0;  ///< edges of more than two polygons
  /// Edges that two polygons pass in the same direction: one is reversed.
  std::int64_t inconsistent_edges = 0;
};

inline constexpr double sliver_share = 0.01;

/// Measures the polygons of a scene. The length and width of a triangle are its longest edge and
/// the height on that edge. The length of another polygon is its diameter (twice the largest
/// distance from the mean of the corners), its width the area over the length. Edges are compared
/// whole: where polygons meet along a part of an edge, the edge is open.
MeshQuality mesh_quality(const Scene& scene);

}  // namespace lightwell
