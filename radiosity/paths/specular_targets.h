#pragma once

#include <Eigen/Core>
#include <vector>

#include "scene/scene.h"

namespace lightwell {

/// A sphere around facets that are mirrors or clear.
struct SpecularTarget {
  Eigen::Vector3d center = Eigen::Vector3d::Zero();
  double radius = 0.0;  ///< m
};

/// What photons are aimed at: the scene's specular surfaces, each a target of its own while there
/// are few; of many, neighbours are one.
class SpecularTargets {
 public:
  static constexpr int most = 64;

  explicit SpecularTargets(const Scene& scene);

  int count() const { return static_cast<int>(targets_.size()); }
  const SpecularTarget& target(int i) const { return targets_[static_cast<std::size_t>(i)]; }
  /// The one a scene-wide facet belongs to; -1: it is not specular.
  int of_facet(int facet) const { return of_facet_[static_cast<std::size_t>(facet)]; }

 private:
  std::vector<SpecularTarget> targets_{};
  std::vector<int> of_facet_{};
};

}  // namespace lightwell
