#pragma once

#include <Eigen/Core>

#include "radiosity/emitters/direct_light.h"

namespace lightwell {

/// The sample point of an emitting polygon for (u, v) in [0,1)^2, uniform in area, metres.
Eigen::Vector3d emitter_point(const Emitter& emitter, double u, double v);

/// Exitance M at a point of an emitter, W/m^2.
Spectrum exitance_at(const Emitter& emitter, const Eigen::Vector3d& point);

}  // namespace lightwell
