#include "raytrace/disc_kernel.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace lightwell {

double kernel_beyond(const Eigen::Vector2d& from, const Eigen::Vector2d& to) {
  const double length = (to - from).norm();
  if (!(length > 0.0)) return 0.0;
  const Eigen::Vector2d along = (to - from) / length;
  const double h = from.x() * along.y() - from.y() * along.x();  // > 0: the centre is on the left
  const double half = std::sqrt(std::max(0.0, 1.0 - h * h));
  if (!(std::abs(h) < 1.0) || h == 0.0) {
    // An edge through the centre turns by pi there or not at all; a disc centred on its own
    // boundary is no case for a formula, and none comes up but by rounding.
    return 0.0;
  }
  const double x0 = std::clamp(from.dot(along), -half, half);
  const double x1 = std::clamp(to.dot(along), -half, half);
  // Around the centre by an angle t, the kernel within the edge at x = h tan(t) is
  //   G(s) dt, G = (s^2 - s^4 / 2) / pi with s^2 = h^2 / cos^2(t),
  // and 1 / (2 pi) dt without it.
  const auto within = [&](double x) {
    return (h * x - 0.5 * (h * h * h * x + h * x * x * x / 3.0)) / std::numbers::pi;
  };
  const double angle = std::atan(x1 / h) - std::atan(x0 / h);
  return angle / (2.0 * std::numbers::pi) - (within(x1) - within(x0));
}

}  // namespace lightwell
