#pragma once

#include <Eigen/Core>

#include "radiosity/emitters/direct_light.h"

namespace lightwell {

/// The place of a polygon that emits for (u, v) in [0,1)^2: evenly spread over its area.
Eigen::Vector3d emitter_point(const Emitter& emitter, double u, double v);

}  // namespace lightwell
