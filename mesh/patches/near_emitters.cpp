#include "mesh/patches/near_emitters.h"

#include <algorithm>
#include <cmath>
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

}  // namespace

NearEmitters::NearEmitters(const Scene& scene) {
  for (std::size_t s = 0; s < scene.surfaces.size(); ++s) {
    const Surface& surface = scene.surfaces[s];
    if (!scene.materials[static_cast<std::size_t>(surface.material)].is_emitter()) continue;
    const int number = static_cast<int>(s);
    if (const auto shape = round_shape(surface)) {
      emitters_.push_back({number, bounds(*shape)});
      continue;
    }
    const auto& mesh = std::get<PolygonMesh>(surface.shape);
    for (const Facet& facet : mesh.facets) {
      Emitter emitter{.surface = number};
      for (const int v : facet.boundary) {
        emitter.box.extend(mesh.vertices[static_cast<std::size_t>(v)]);
      }
      emitters_.push_back(emitter);
    }
  }
  for (const Lamp& lamp : scene.lamps) {
    emitters_.push_back({-1, Eigen::AlignedBox3d(lamp.position)});
  }
}

double NearEmitters::distance(const RoundShape& shape, int surface, double farthest) const {
  const Sphere ball = ball_around(shape);
  double nearest = farthest;
  for (const Emitter& emitter : emitters_) {
    if (emitter.surface == surface) continue;
    if (emitter.box.exteriorDistance(ball.center) - ball.radius >= nearest) continue;
    nearest = std::min(nearest, distance_between(shape, emitter.box));
  }
  return nearest;
}

CutSize NearEmitters::cut(const RoundShape& shape, int surface, const CutSize& size) const {
  // Linear elements of a quarter of the distance d are off by (d / 4)^2 / 8 times the second
  // derivative of 1 / d^2, 5 % of the light.
  constexpr double share = 0.25, most = 16.0;
  const double h = size.element_size(), wanted = share * distance(shape, surface, h / share);
  CutSize finer = size;
  finer.elements_per_edge *=
      static_cast<int>(std::ceil(std::min(most, h / std::max(wanted, h / most))));
  return finer;
}

}  // namespace lightwell
