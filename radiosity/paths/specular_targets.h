#pragma once

#include <Eigen/Core>
#include <vector>

#include "scene/scene.h"

namespace lightwell {

/// A sphere around specular facets (mirrors or clear surfaces).
struct SpecularTarget {
  Eigen::Vector3d center = Eigen::Vector3d::Zero();
  double radius = 0.0;  ///< m
};

/// Targets of photons: the scene's specular surfaces, one target each while there are few;
/// neighbours share a target where there are many.
class SpecularTargets {
 public:
  static constexpr int most = 64;

  explicit SpecularTargets(const Scene& scene);

  int count() const { return static_cast<int>(targets_.size()); }
  const SpecularTarget& target(int i) const { return targets_[static_cast<std::size_t>(i)]; }
  /// The target of a scene-wide facet; -1: the facet is not specular.
  int of_facet(int facet) const { return of_facet_[static_cast<std::size_t>(facet)]; }

 private:
  std::vector<SpecularTarget> targets_{};
  std::vector<int> of_facet_{};
};

}  // namespace lightwell
