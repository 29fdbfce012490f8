#pragma once

#include <Eigen/Core>
#include <utility>
#include <vector>

namespace lightwell {

/// Closed lines in a plane, m: what an odd number of them surrounds is within.
struct GridOutline {
  std::vector<std::pair<Eigen::Vector2d, Eigen::Vector2d>> edges{};  ///< each of some length

  /// True of points within that are `margin` m, >= 0, or more from all lines.
  bool holds(const Eigen::Vector2d& p, double margin) const;
};

/// Area within a closed line less that within the others, which lie inside of it, m^2. Each line is
/// a list of corners.
double area_within(const std::vector<std::vector<Eigen::Vector2d>>& loops);

}  // namespace lightwell
