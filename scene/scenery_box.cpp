#include "scene/scenery_box.h"

#include <algorithm>
#include <span>
#include <utility>
#include <variant>

#include "scene/round_shape.h"

namespace lightwell {
namespace {

// Distance of the farthest point of a box from `center`, m.
double reach(const Eigen::AlignedBox3d& box, const Eigen::Vector3d& center) {
  const Eigen::Vector3d low = (box.min() - center).cwiseAbs();
  return low.cwiseMax((box.max() - center).cwiseAbs()).norm();
}

// True if all `boxes` reach far beyond the scenery.
bool is_backdrop(std::span<const Eigen::AlignedBox3d> boxes, const Eigen::AlignedBox3d& scenery) {
  constexpr double far = 100.0;
  const double least = far * scenery.diagonal().norm();
  return std::ranges::all_of(
      boxes, [&](const auto& box) { return reach(box, scenery.center()) >= least; });
}

}  // namespace

Eigen::AlignedBox3d scenery_box(std::vector<Eigen::AlignedBox3d> boxes) {
  constexpr std::size_t fewest = 6;  // facets of a body
  std::ranges::stable_sort(boxes, {}, [](const auto& box) { return box.diagonal().squaredNorm(); });
  Eigen::AlignedBox3d scenery;
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    if (i >= fewest &&
        is_backdrop({boxes.begin() + static_cast<std::ptrdiff_t>(i), boxes.end()}, scenery)) {
      break;
    }
    scenery.extend(boxes[i]);
  }
  return scenery;
}

Eigen::AlignedBox3d scenery_box(const Scene& scene) {
  std::vector<Eigen::AlignedBox3d> boxes;
  for (const Surface& surface : scene.surfaces) {
    const auto* mesh = std::get_if<PolygonMesh>(&surface.shape);
    if (!mesh) boxes.push_back(bounds(*round_shape(surface)));
    if (!mesh) continue;
    for (const Facet& facet : mesh->facets) {
      auto& box = boxes.emplace_back();
      for (const int v : facet.boundary) box.extend(mesh->vertices[static_cast<std::size_t>(v)]);
    }
  }
  return scenery_box(std::move(boxes));
}

}  // namespace lightwell
