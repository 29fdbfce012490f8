#pragma once

#include <Eigen/Core>
#include <vector>

#include "mesh/patches/patch_mesh.h"

namespace lightwell {

/// Regions of elements over which light is continuous: elements connected by shared mesh vertices.
/// A wall that crosses a floor from side to side divides the floor into two regions. At the edges
/// of a block each face ends its own region.
struct LightRegions {
  /// Edge of a region's boundary, counter-clockwise seen from the lit side.
  struct Edge {
    Eigen::Vector3d from, to;
  };
  std::vector<int> of_element{};            ///< region of each element, numbered from 0
  std::vector<std::vector<Edge>> bounds{};  ///< boundary edges per region

  int count() const { return static_cast<int>(bounds.size()); }
};

LightRegions light_regions(const PatchMesh& mesh);

}  // namespace lightwell
