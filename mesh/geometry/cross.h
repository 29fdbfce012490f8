#pragma once

#include <Eigen/Core>

namespace lightwell {

/// Twice the area that two vectors of a plane span; positive where b lies to the left of a.
inline double cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  return a.x() * b.y() - a.y() * b.x();
}

}  // namespace lightwell
