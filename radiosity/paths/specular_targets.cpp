#include "radiosity/paths/specular_targets.h"
#include "scene/round_shape.h"

#include <algorithm>
#include <limits>
#include <span>
#include <utility>

namespace lightwell {
namespace {

struct Box {
  Eigen::Vector3d low = Eigen::Vector3d::Constant(std::numeric_limits<double>::infinity());
  Eigen::Vector3d high = -low;

  void add(const Eigen::Vector3d& p) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  void add(const Box& other) {
    low = low.cwiseMin(other.low);
    high = high.cwiseMax(other.high);
  }
  Eigen::Vector3d center() const { return 0.5 * (low + high); }
  /// Squared radius of the sphere around the group.
  double radius2() const { return 0.25 * (high - low).squaredNorm(); }
};

Box joined_boxes(Box a, const Box& b) {
  a.add(b);
  return a;
}

Box box_of(const Surface& surface) {
  Box box;
  if (const auto shape = round_shape(surface)) {
    box.add(bounds(*shape).min());
    box.add(bounds(*shape).max());
    return box;
  }
  const auto& polygons = std::get<PolygonMesh>(surface.shape);
  for (const Facet& facet : polygons.facets) {
    for (const int v : facet.boundary) box.add(polygons.vertices[static_cast<std::size_t>(v)]);
  }
  return box;
}

// Halves the set of surfaces along its longest side until there are `groups` groups.
void divide(std::span<std::pair<int, Box>> surfaces, int groups, int first,
            std::vector<int>& group) {
  if (groups == 1 || surfaces.size() <= 1) {
    for (const auto& [surface, box] : surfaces) group[static_cast<std::size_t>(surface)] = first;
    return;
  }
  Box all;
  for (const auto& [surface, box] : surfaces) all.add(box.center());
  Eigen::Index axis = 0;
  (all.high - all.low).maxCoeff(&axis);
  const auto middle = surfaces.begin() + static_cast<std::ptrdiff_t>(surfaces.size() / 2);
  std::nth_element(surfaces.begin(), middle, surfaces.end(), [&](const auto& a, const auto& b) {
    return std::pair(a.second.center()[axis], a.first) <
           std::pair(b.second.center()[axis], b.first);
  });
  const std::size_t left = surfaces.size() / 2;
  divide(surfaces.first(left), groups / 2, first, group);
  divide(surfaces.subspan(left), groups - groups / 2, first + groups / 2, group);
}

// Joins groups whose common sphere fills less solid angle than their spheres together, such as the
// faces of a block, best pair first.
void join_neighbours(std::vector<Box>& boxes, std::vector<int>& group) {
  for (;;) {
    double best = 1.0;
    std::pair<std::size_t, std::size_t> pair{0, 0};
    for (std::size_t a = 0; a < boxes.size(); ++a) {
      for (std::size_t b = a + 1; b < boxes.size(); ++b) {
        const double apart = boxes[a].radius2() + boxes[b].radius2();
        const double ratio = joined_boxes(boxes[a], boxes[b]).radius2() / apart;
        if (ratio < best) {
          best = ratio;
          pair = {a, b};
        }
      }
    }
    const auto [a, b] = pair;
    if (a == b) return;
    boxes[a].add(boxes[b]);
    boxes.erase(boxes.begin() + static_cast<std::ptrdiff_t>(b));
    for (int& g : group) {
      if (g == static_cast<int>(b)) {
        g = static_cast<int>(a);
      } else if (g > static_cast<int>(b)) {
        --g;
      }
    }
  }
}

}  // namespace

SpecularTargets::SpecularTargets(const Scene& scene) {
  std::vector<std::pair<int, Box>> specular;
  for (int s = 0; s < static_cast<int>(scene.surfaces.size()); ++s) {
    const Surface& surface = scene.surfaces[static_cast<std::size_t>(s)];
    if (!scene.materials[static_cast<std::size_t>(surface.material)].is_specular()) continue;
    specular.emplace_back(s, box_of(surface));
  }
  std::vector<int> group(scene.surfaces.size(), -1);
  divide(specular, std::max(1, std::min(most, static_cast<int>(specular.size()))), 0, group);

  std::vector<Box> boxes;
  for (const auto& [surface, box] : specular) {
    const auto g = static_cast<std::size_t>(group[static_cast<std::size_t>(surface)]);
    if (boxes.size() <= g) boxes.resize(g + 1);
    boxes[g].add(box);
  }
  join_neighbours(boxes, group);
  for (const Box& box : boxes) {
    targets_.push_back({.center = box.center()});
  }
  // The distance to the farthest point, enlarged a little, since rays end in single precision.
  constexpr double hair = 1.0 + 1e-5;
  const auto reach = [&](SpecularTarget& target, const Surface& surface) {
    if (const auto shape = round_shape(surface)) {
      const Sphere ball = ball_around(*shape);
      const double to = (ball.center - target.center).norm() + ball.radius;
      target.radius = std::max(target.radius, hair * to);
      return;
    }
    const auto& polygons = std::get<PolygonMesh>(surface.shape);
    for (const Facet& facet : polygons.facets) {
      for (const int v : facet.boundary) {
        const Eigen::Vector3d& p = polygons.vertices[static_cast<std::size_t>(v)];
        target.radius = std::max(target.radius, hair * (p - target.center).norm());
      }
    }
  };
  for (const auto& [surface, box] : specular) {
    const auto s = static_cast<std::size_t>(surface);
    reach(targets_[static_cast<std::size_t>(group[s])], scene.surfaces[s]);
  }
  for (const FacetRef& ref : scene_facets(scene)) {
    of_facet_.push_back(group[static_cast<std::size_t>(ref.surface)]);
  }
}

}  // namespace lightwell
