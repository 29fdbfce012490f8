#pragma once

#include "mesh/geometry/box_tree.h"

namespace lightwell {

/// A box of a tree about the points a and b of a facet's frame, `by` metres wider on each side.
inline BoxTree::Box flat_box(const Eigen::Vector2d& a, const Eigen::Vector2d& b, double by) {
  const auto lifted = [](const Eigen::Vector2d& q) { return Eigen::Vector3d(q.x(), q.y(), 0.0); };
  BoxTree::Box box(lifted(a.cwiseMin(b).array() - by));
  return box.extend(lifted(a.cwiseMax(b).array() + by));
}

}  // namespace lightwell
