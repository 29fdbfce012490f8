#include "scene/scenery_box.h"

#include <algorithm>
#include <numeric>
#include <span>
#include <variant>

#include "scene/round_shape.h"

namespace lightwell {
namespace {

// Distance of the farthest point of a box from `center`, m.
double reach(const Eigen::AlignedBox3d& box, const Eigen::Vector3d& center) {
  const Eigen::Vector3d low = (box.min() - center).cwiseAbs();
  return low.cwiseMax((box.max() - center).cwiseAbs()).norm();
}

// Least reach of surroundings from the middle of what is near, as shares of its length: of each
// facet, and of the farthest.
struct Reach {
  double each = 0.0, farthest = 0.0;
};

// Boxes of facets, the smallest first, and how many of these are near.
struct Parted {
  std::vector<std::size_t> order{};  // indices of boxes
  std::size_t near_count = 0;
  Eigen::AlignedBox3d box{};  // of what is near
};

// Looks for surroundings among boxes in order, behind what is known to be near.
class Surroundings {
 public:
  Surroundings(std::span<const Eigen::AlignedBox3d> boxes, std::span<const std::size_t> order,
               const Reach& reach)
      : boxes_(boxes), order_(order), reach_(reach) {}

  // True if all boxes from order[first] on surround the scenery.
  bool begin_at(std::size_t first, const Eigen::AlignedBox3d& scenery) {
    const double length = scenery.diagonal().norm();
    const auto is_close = [&](std::size_t k) {
      return !(reach(boxes_[order_[k]], scenery.center()) >= reach_.each * length);
    };
    // The box that was close the last time is close to scenery that has grown, too, nearly always.
    if (last_ >= first && is_close(last_)) return false;
    double farthest = 0.0;
    for (std::size_t k = first; k < order_.size(); ++k) {
      if (is_close(k)) {
        last_ = k;
        return false;
      }
      farthest = std::max(farthest, reach(boxes_[order_[k]], scenery.center()));
    }
    return farthest >= reach_.farthest * length;
  }

 private:
  std::span<const Eigen::AlignedBox3d> boxes_;
  std::span<const std::size_t> order_;
  Reach reach_;
  std::size_t last_ = 0;
};

Parted parted(std::span<const Eigen::AlignedBox3d> boxes, const Reach& reach) {
  constexpr std::size_t fewest = 6;  // facets of a body
  Parted result;
  result.order.resize(boxes.size());
  std::iota(result.order.begin(), result.order.end(), std::size_t{0});
  std::vector<double> length2;
  length2.reserve(boxes.size());
  for (const Eigen::AlignedBox3d& box : boxes) length2.push_back(box.diagonal().squaredNorm());
  std::ranges::stable_sort(result.order, {}, [&](std::size_t i) { return length2[i]; });
  Surroundings surroundings(boxes, result.order, reach);
  for (; result.near_count < boxes.size(); ++result.near_count) {
    if (result.near_count >= fewest && surroundings.begin_at(result.near_count, result.box)) break;
    result.box.extend(boxes[result.order[result.near_count]]);
  }
  return result;
}

constexpr Reach near_reach{.each = 2.0, .farthest = 16.0};

// Flags of the boxes: 1 for a box that is near.
std::vector<char> near_of(const Parted& parts) {
  std::vector<char> is_near(parts.order.size(), 0);
  for (std::size_t k = 0; k < parts.near_count; ++k) is_near[parts.order[k]] = 1;
  return is_near;
}

// The boxes of all facets and round shapes, by facet of the scene.
std::vector<Eigen::AlignedBox3d> facet_boxes(const Scene& scene) {
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
  return boxes;
}

}  // namespace

Eigen::AlignedBox3d scenery_box(const std::vector<Eigen::AlignedBox3d>& boxes) {
  return parted(boxes, {.each = 100.0, .farthest = 100.0}).box;
}

Eigen::AlignedBox3d scenery_box(const Scene& scene) {
  return scenery_box(facet_boxes(scene));
}

Scenery all_near(const Scene& scene) {
  const Bounds bounds = scene_bounds(scene);
  return {.box = {bounds.low, bounds.high},
          .is_near = std::vector<char>(scene_facets(scene).size(), 1)};
}

Scenery near_scenery(const Scene& scene) {
  const std::vector<Eigen::AlignedBox3d> boxes = facet_boxes(scene);
  const Parted parts = parted(boxes, near_reach);
  if (parts.near_count == boxes.size()) return all_near(scene);
  return {.box = parts.box, .is_near = near_of(parts), .has_surroundings = true};
}

double scenery_length(const Scene& scene) {
  return near_scenery(scene).box.diagonal().norm();
}

double coordinate_length(const Scene& scene) {
  const Scenery scenery = near_scenery(scene);
  const double length = scenery.box.diagonal().norm();
  if (!scenery.has_surroundings) return length;
  const double farthest = reach(scenery.box, Eigen::Vector3d::Zero());
  return std::min(std::max(length, farthest), scene_bounds(scene).diagonal());
}

std::vector<char> are_near(const std::vector<Eigen::AlignedBox3d>& boxes) {
  return near_of(parted(boxes, near_reach));
}

}  // namespace lightwell
