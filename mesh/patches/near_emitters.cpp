#include "mesh/patches/near_emitters.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>
#include <variant>

namespace lightwell {
namespace {

// Distance of a shape from a box, by projections to and fro: exact between convex bodies in the
// limit, and from the inside of a shade to a bulb.
double distance_between(const RoundShape& shape, const Eigen::AlignedBox3d& box) {
  constexpr int turns = 4;
  Eigen::Vector3d in_box = box.center();
  Eigen::Vector3d on_shape = nearest_on(shape, in_box);
  for (int i = 0; i < turns; ++i) {
    in_box = on_shape.cwiseMax(box.min()).cwiseMin(box.max());
    on_shape = nearest_on(shape, in_box);
  }
  return (on_shape - in_box).norm();
}

// The box of each emitting facet and lamp of a scene, and the surface of each; -1 for lamps.
struct EmitterBoxes {
  std::vector<Eigen::AlignedBox3d> boxes{};
  std::vector<int> surface{};

  explicit EmitterBoxes(const Scene& scene) {
    for (std::size_t s = 0; s < scene.surfaces.size(); ++s) {
      const Surface& own = scene.surfaces[s];
      if (!scene.materials[static_cast<std::size_t>(own.material)].is_emitter()) continue;
      if (const auto shape = round_shape(own)) {
        boxes.push_back(bounds(*shape));
      } else {
        add_facets(std::get<PolygonMesh>(own.shape));
      }
      surface.resize(boxes.size(), static_cast<int>(s));
    }
    for (const Lamp& lamp : scene.lamps) boxes.emplace_back(lamp.position);
    surface.resize(boxes.size(), -1);
  }

  void add_facets(const PolygonMesh& mesh) {
    for (const Facet& facet : mesh.facets) {
      auto& box = boxes.emplace_back();
      for (const int v : facet.boundary) box.extend(mesh.vertices[static_cast<std::size_t>(v)]);
    }
  }
};

}  // namespace

NearEmitters::NearEmitters(const Scene& scene) : tree_({}) {
  EmitterBoxes emitters(scene);
  boxes_ = std::move(emitters.boxes);
  surface_ = std::move(emitters.surface);
  tree_ = BoxTree(boxes_);
}

double NearEmitters::distance(const RoundShape& shape, int surface, double farthest) const {
  Eigen::AlignedBox3d around = bounds(shape);
  const Eigen::Vector3d margin = Eigen::Vector3d::Constant(farthest);
  around = {around.min() - margin, around.max() + margin};
  std::vector<int> found;
  tree_.find_overlaps(around, found);
  double nearest = farthest;
  for (const int i : found) {
    const auto e = static_cast<std::size_t>(i);
    if (surface_[e] != surface) nearest = std::min(nearest, distance_between(shape, boxes_[e]));
  }
  return nearest;
}

CutSize NearEmitters::cut(const RoundShape& shape, int surface, const CutSize& size) const {
  // Linear elements of a quarter of the distance d are off by (d / 4)^2 / 8 times the second
  // derivative of 1 / d^2, 5 % of the light.
  constexpr double share = 0.25, most_times = 16.0, of_ball = 1.0 / 12.0;
  const double h = size.element_size();
  const double shortest = std::max(h / most_times, of_ball * ball_around(shape).radius);
  const double wanted = std::max(shortest, share * distance(shape, surface, h / share));
  CutSize finer = size;
  finer.elements_per_edge *= static_cast<int>(std::ceil(std::max(1.0, h / wanted)));
  return finer;
}

CutSize fine_enough(const RoundShape& shape, const CutSize& size, int spheres) {
  constexpr double most_elements = 65536.0, most_rings = 8.0;
  const auto* sphere = std::get_if<Sphere>(&shape);
  if (!sphere) return size;
  // Elements about as long as wide: 2 n^2 for n rings.
  const double rings = std::floor(std::min(most_rings, std::sqrt(most_elements / (2.0 * spheres))));
  // Inverse of CutSize::pieces() for a meridian. All patches longer than a ball's parallels cut the
  // ball alike, so those of balls that are much smaller count as shorter: integers hold no more
  // elements along an edge.
  constexpr double longest_patch = 1024.0;  // meridians
  const double meridian = std::numbers::pi * sphere->radius;
  CutSize fine = size;
  double per_edge = 0.0;
  if (meridian < size.patch_size) {
    fine.patch_size = std::min(size.patch_size, longest_patch * meridian);
    per_edge = std::floor(rings * fine.patch_size / meridian);
  } else {
    per_edge = std::ceil(rings / size.patches(meridian));
  }
  fine.elements_per_edge = static_cast<int>(per_edge);
  return per_edge >= 1.0 && fine.element_size() < size.element_size() ? fine : size;
}

}  // namespace lightwell
