#include "radiosity/parts/backdrop.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cstddef>

namespace lightwell {
namespace {

// The boxes of surfaces, by the corners of their elements.
std::vector<Eigen::AlignedBox3d> surface_boxes(const Scene& scene, const PatchMesh& mesh) {
  std::vector<Eigen::AlignedBox3d> boxes(scene.surfaces.size());
  for (int e = 0; e < mesh.element_count(); ++e) {
    for (int c = 0; c < mesh.corner_count(e); ++c) {
      boxes[mesh.surface[mesh.patch[e]]].extend(mesh.position(mesh.corners[e][c]));
    }
  }
  return boxes;
}

// True if a box holds `scenery` far inside, but for one side: domes may end on the ground, or a
// little above what stands there. A wall beside a lamp is around the lamp on five sides as well,
// and wholly beyond it on the sixth.
bool is_around(const Eigen::AlignedBox3d& box, const Eigen::AlignedBox3d& scenery) {
  const double away = scenery.diagonal().norm();
  const Eigen::Array3d below = scenery.min() - box.min(), above = box.max() - scenery.max();
  const bool is_within = (below > -away).all() && (above > -away).all();
  return is_within && (below >= away).count() + (above >= away).count() >= 5;
}

}  // namespace

std::vector<char> backdrop_patches(const Scene& scene, const PatchMesh& mesh) {
  constexpr double far = 10.0;
  const std::vector<Eigen::AlignedBox3d> boxes = surface_boxes(scene, mesh);
  std::vector<int> by_size;
  for (std::size_t s = 0; s < boxes.size(); ++s) {
    if (!boxes[s].isEmpty()) by_size.push_back(static_cast<int>(s));
  }
  const auto size = [&](int s) { return boxes[s].diagonal().norm(); };
  std::ranges::stable_sort(by_size, {}, size);
  std::vector<char> is_backdrop(boxes.size(), 0);
  Eigen::AlignedBox3d scenery;
  std::size_t smaller = 0;
  for (const int s : by_size) {
    for (; far * size(by_size[smaller]) <= size(s); ++smaller) {
      scenery.extend(boxes[by_size[smaller]]);
    }
    const bool is_far = !scenery.isEmpty() && far * scenery.diagonal().norm() <= size(s);
    is_backdrop[s] = is_far && is_around(boxes[s], scenery) ? 1 : 0;
  }
  std::vector<char> of_patch;
  for (int p = 0; p < mesh.patch_count(); ++p) {
    of_patch.push_back(is_backdrop[mesh.surface[p]]);
  }
  return of_patch;
}

}  // namespace lightwell
