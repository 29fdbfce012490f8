#pragma once

#include <Eigen/Core>

#include "radiosity/emitters/emitter.h"

namespace lightwell {

/// The sample point of an emitting polygon for (u, v) in [0,1)^2, uniform in area, metres.
Eigen::Vector3d emitter_point(const Emitter& emitter, double u, double v);

/// Approximate kernel of an emitter's light at a point, cos / r^2 of its middle, 1/m^2: 0 only if
/// the emitter sends nothing there. Beside a large emitter, parts of it are nearer than its middle
/// and seen less edge on.
double approximate_kernel(const Emitter& emitter, const Eigen::Vector3d& from);

/// Exitance M at a point of an emitter, W/m^2.
Spectrum exitance_at(const Emitter& emitter, const Eigen::Vector3d& point);

}  // namespace lightwell
