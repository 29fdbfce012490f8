#include "mesh/patches/mesh_bounds.h"

#include <limits>
#include <utility>
#include <vector>

#include "scene/scenery_box.h"

namespace lightwell {

Bounds mesh_bounds(const PatchMesh& mesh) {
  Bounds bounds{Eigen::Vector3d::Constant(std::numeric_limits<double>::infinity()),
                Eigen::Vector3d::Constant(-std::numeric_limits<double>::infinity())};
  for (int v = 0; v < mesh.vertex_count(); ++v) {
    bounds.low = bounds.low.cwiseMin(mesh.position(v));
    bounds.high = bounds.high.cwiseMax(mesh.position(v));
  }
  return bounds;
}

Bounds scenery_bounds(const PatchMesh& mesh) {
  std::vector<Eigen::AlignedBox3d> boxes;  // by facet; empty for one without elements
  for (int e = 0; e < mesh.element_count(); ++e) {
    const auto facet = static_cast<std::size_t>(mesh.facet[e]);
    if (facet >= boxes.size()) boxes.resize(facet + 1);
    for (int c = 0; c < mesh.corner_count(e); ++c) {
      boxes[facet].extend(mesh.position(mesh.corners[e][c]));
    }
  }
  std::erase_if(boxes, [](const auto& box) { return box.isEmpty(); });
  const Eigen::AlignedBox3d scenery = scenery_box(std::move(boxes));
  return {scenery.min(), scenery.max()};
}

}  // namespace lightwell
