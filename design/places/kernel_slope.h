#pragma once

#include <Eigen/Core>

#include "scene/lamp.h"
#include "scene/surface_point.h"

namespace lightwell {

/// The kernel K = S(omega) cos / r^2 of the irradiance of a point by a lamp's point, 1/m^2 (see
/// unoccluded_kernel()), and its derivative by the place of the lamp, 1/m^3.
struct KernelSlope {
  double kernel = 0.0;
  Eigen::Vector3d gradient = Eigen::Vector3d::Zero();
};

/// Kernel and derivative of a point `on_lamp` of the lamp's opening, which moves with the lamp and
/// keeps its direction. With v from the receiver to the point, r = |v|, h = v n and omega = -v / r,
///
///     K = S h / r^3
///     dK/dx = S n / r^3 - 3 S h v / r^5 - (h / r^4) sum_t (dS/dt) t
///
/// where t are two directions across omega, and dS/dt is the derivative of the lamp's intensity by
/// the angle towards t. A measured distribution is linear between its angles; where two of its
/// slopes meet, dS/dt is their mean. 0 for a point behind the receiver. The distance that a
/// projected picture is focused at is not followed.
KernelSlope kernel_slope(const Lamp& lamp, const Eigen::Vector3d& on_lamp, const SurfacePoint& at);

}  // namespace lightwell
