#include "raytrace/disc_kernel.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "scene/sampling.h"

namespace lightwell {

double kernel_beyond(const Eigen::Vector2d& from, const Eigen::Vector2d& to) {
  const double length = (to - from).norm();
  if (!(length > 0.0)) return 0.0;
  const Eigen::Vector2d along = (to - from) / length;
  const double h = from.x() * along.y() - from.y() * along.x();  // > 0: the centre is on the left
  const double half = std::sqrt(std::max(0.0, 1.0 - h * h));
  // An edge through the very centre has no side to be on; it cuts off nothing.
  if (!(std::abs(h) < 1.0) || h == 0.0) return 0.0;
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

double kernel_within(const Eigen::Vector3d& center, const Eigen::Vector3d& normal, double radius,
                     std::span<const LightRegions::Edge> edges) {
  Eigen::Vector3d a, b;
  tangent_frame(normal, a, b);
  double beyond = 0.0;
  for (const LightRegions::Edge& edge : edges) {
    const Eigen::Vector3d from = (edge.from - center) / radius, to = (edge.to - center) / radius;
    beyond += kernel_beyond({from.dot(a), from.dot(b)}, {to.dot(a), to.dot(b)});
  }
  constexpr double least = 0.02;
  return std::clamp(1.0 - beyond, least, 1.0);
}

}  // namespace lightwell
