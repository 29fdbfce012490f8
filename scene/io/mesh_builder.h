#pragma once

#include <array>
#include <map>
#include <vector>

#include "scene/io/corner_maps.h"
#include "scene/io/polygon.h"
#include "scene/scene.h"

namespace lightwell {

/// Collects polygons into a PolygonMesh in which equal positions are one vertex.
class MeshBuilder {
 public:
  /// Adds a valid polygon. Holes get the winding opposite to the boundary's. `uv` and `normals` are
  /// given at the boundary's corners; the facet has a map where uv_map_over() and normal_map_over()
  /// find one.
  void add(const Polygon& polygon, const UvLoop& uv = {}, const NormalLoop& normals = {});
  bool empty() const { return mesh_.facets.empty(); }
  const PolygonMesh& mesh() const { return mesh_; }

 private:
  std::vector<int> indices(const Loop& loop);
  int uv_map(const Loop& loop, const UvLoop& uv);
  int normal_map(const Loop& loop, const NormalLoop& normals);
  PolygonMesh mesh_;
  std::map<std::array<double, 3>, int> index_of_;
};

}  // namespace lightwell
