#pragma once

#include <Eigen/Core>
#include <vector>

#include "mesh/patches/patch_mesh.h"

namespace lightwell {

/// Elements over which light is continuous: those that mesh vertices join. A wall that stands on a
/// floor from side to side parts it in two; the edges of a block are those of its faces.
struct LightRegions {
  /// Of a region's boundary, counter-clockwise seen from the side that is lit.
  struct Edge {
    Eigen::Vector3d from, to;
  };
  std::vector<int> of_element{};            ///< numbered from 0
  std::vector<std::vector<Edge>> bounds{};  ///< per region

  int count() const { return static_cast<int>(bounds.size()); }
};

LightRegions light_regions(const PatchMesh& mesh);

}  // namespace lightwell
