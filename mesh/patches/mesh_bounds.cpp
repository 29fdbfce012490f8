#include "mesh/patches/mesh_bounds.h"

#include <limits>
#include <vector>

#include "scene/scenery_box.h"

namespace lightwell {

namespace {

// The box of each facet's elements, empty for one without.
std::vector<Eigen::AlignedBox3d> facet_boxes(const PatchMesh& mesh) {
  std::vector<Eigen::AlignedBox3d> boxes;
  for (int e = 0; e < mesh.element_count(); ++e) {
    const auto facet = static_cast<std::size_t>(mesh.facet[e]);
    if (facet >= boxes.size()) boxes.resize(facet + 1);
    for (int c = 0; c < mesh.corner_count(e); ++c) {
      boxes[facet].extend(mesh.position(mesh.corners[e][c]));
    }
  }
  return boxes;
}

}  // namespace

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
  std::vector<Eigen::AlignedBox3d> boxes = facet_boxes(mesh);
  std::erase_if(boxes, [](const auto& box) { return box.isEmpty(); });
  const Eigen::AlignedBox3d scenery = scenery_box(boxes);
  return {scenery.min(), scenery.max()};
}

std::vector<char> near_facets(const PatchMesh& mesh) {
  const std::vector<Eigen::AlignedBox3d> all = facet_boxes(mesh);
  std::vector<Eigen::AlignedBox3d> boxes = all;
  std::erase_if(boxes, [](const auto& box) { return box.isEmpty(); });
  const std::vector<char> of_boxes = are_near(boxes);
  std::vector<char> is_near;
  std::size_t next = 0;
  for (const auto& box : all) is_near.push_back(box.isEmpty() ? 0 : of_boxes[next++]);
  return is_near;
}

}  // namespace lightwell
