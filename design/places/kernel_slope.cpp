#include "design/places/kernel_slope.h"

#include <cmath>

#include "scene/sampling.h"

namespace lightwell {
namespace {

// Angle, radians, over half of which dS/dt is a central difference. Its square times a third
// derivative, for spots about 1e-8, is the error beside 1e-12 by rounding; the steps of photometric
// files are a hundred times as wide.
constexpr double small_angle = 1e-4;

double slope_towards(const Lamp& lamp, const Eigen::Vector3d& omega, const Eigen::Vector3d& t,
                     double r) {
  const Eigen::Vector3d along = std::cos(small_angle) * omega, aside = std::sin(small_angle) * t;
  return (relative_intensity(lamp, along + aside, r) - relative_intensity(lamp, along - aside, r)) /
         (2.0 * small_angle);
}

}  // namespace

KernelSlope kernel_slope(const Lamp& lamp, const Eigen::Vector3d& on_lamp, const SurfacePoint& at) {
  const Eigen::Vector3d v = on_lamp - at.position;
  const double h = v.dot(at.normal), r2 = v.squaredNorm();
  if (!(h > 0.0 && r2 > 0.0)) return {};
  const double r = std::sqrt(r2), r3 = r2 * r;
  const Eigen::Vector3d omega = -v / r;
  const double S = relative_intensity(lamp, omega, r);
  Eigen::Vector3d a, b;
  tangent_frame(omega, a, b);
  const Eigen::Vector3d across =
      slope_towards(lamp, omega, a, r) * a + slope_towards(lamp, omega, b, r) * b;
  return {.kernel = S * h / r3,
          .gradient = S / r3 * (at.normal - 3.0 * h / r2 * v) - h / (r2 * r2) * across};
}

}  // namespace lightwell
