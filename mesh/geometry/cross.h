#pragma once

#include <Eigen/Core>

namespace lightwell {

/// The cross product a.x b.y - a.y b.x of two vectors of a plane: the area of their parallelogram,
/// positive where b lies to the left of a.
inline double cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  return a.x() * b.y() - a.y() * b.x();
}

}  // namespace lightwell
