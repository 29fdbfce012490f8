#pragma once

#include <Eigen/Core>

#include "radiosity/emitters/direct_light.h"

namespace lightwell {

/// The sample point of an emitting polygon for (u, v) in [0,1)^2, uniform in area, metres.
Eigen::Vector3d emitter_point(const Emitter& emitter, double u, double v);

}  // namespace lightwell
