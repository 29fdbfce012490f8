#pragma once

#include <algorithm>

#include "radiosity/many_lights/light_tree.h"

namespace lightwell {

/// About the most that the lights of a node can give a point, W/m^2, where none sends more than
/// `intensity` of the sum of all, W/sr: a weight of LightTree::draw_by(). 0 only if all are below
/// the horizon or dark; finite also within the node's box, whose points count as no nearer than the
/// ball about it.
inline double may_give(const LightNode& node, double intensity, const SurfacePoint& at) {
  const Eigen::Vector3d to = node.middle - at.position;
  const double height = to.dot(at.normal) + node.half.dot(at.normal.cwiseAbs());
  if (!(height > 0.0)) return 0.0;
  const double away = std::max(to.norm(), node.radius);
  return intensity * height / (away * away * away);
}

}  // namespace lightwell
