#pragma once

#include <functional>
#include <vector>

#include "mesh/elements/element_caster.h"
#include "scene/scene.h"

namespace lightwell {

/// A place that is not specular and that a ray shows, straight or by way of mirrors and glass.
struct TracedPoint {
  int surface = -1;                                    ///< index into Scene::surfaces
  int facet = -1;                                      ///< scene-wide facet number
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< metres
  double weight = 1.0;  ///< share of the place's radiance that comes back along the ray
  int bounces = 0;      ///< specular events on the way; 0: seen straight
};

/// Follows a ray's tree through the scene's mirrors and glass without shading: what is where in a
/// picture. Written apart from the renderer that it helps to judge.
class Sightlines {
 public:
  Sightlines(const Scene& scene, const ElementCaster& caster);

  /// Calls `show` for every place whose weight is at least `least_weight`.
  void trace(const Ray& ray, double least_weight,
             const std::function<void(const TracedPoint&)>& show) const;

  /// The surface straight ahead; -1: none.
  int surface_ahead(const Ray& ray) const;

  const Scene& scene() const { return scene_; }
  int surface_count() const { return static_cast<int>(scene_.surfaces.size()); }

 private:
  void follow(const Ray& ray, double weight, int bounces, double least_weight,
              const std::function<void(const TracedPoint&)>& show) const;

  const Scene& scene_;
  const ElementCaster& caster_;
  std::vector<FacetRef> facets_;
};

}  // namespace lightwell
