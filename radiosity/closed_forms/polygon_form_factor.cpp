#include "radiosity/closed_forms/polygon_form_factor.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

namespace lightwell {
namespace {

// Gamma_k . n of the edge between points a and b as seen from the origin: the angle that the edge
// subtends times the unit normal of the plane through edge and origin. atan2 is accurate for edges
// that subtend almost nothing or almost 180 degrees.
double edge_term(const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                 const Eigen::Vector3d& normal) {
  const Eigen::Vector3d cross = a.cross(b);
  const double sine = cross.norm();
  if (!(sine > 0.0)) return 0.0;  // the edge points at the element: no angle
  return std::atan2(sine, a.dot(b)) * cross.dot(normal) / sine;
}

// Sum of edge_term over the part of the loop above the horizon (Sutherland & Hodgman against one
// plane, without storing the clipped loop).
double loop_term(const Eigen::Vector3d& point, const Eigen::Vector3d& normal,
                 std::span<const Eigen::Vector3d> loop) {
  double sum = 0.0;
  bool started = false;
  Eigen::Vector3d first, previous;
  const auto visit = [&](const Eigen::Vector3d& v) {
    if (started) {
      sum += edge_term(previous, v, normal);
    } else {
      first = v;
      started = true;
    }
    previous = v;
  };
  Eigen::Vector3d a = loop.back() - point;
  double height_a = a.dot(normal);
  for (const Eigen::Vector3d& vertex : loop) {
    const Eigen::Vector3d b = vertex - point;
    const double height_b = b.dot(normal);
    if ((height_a > 0.0) != (height_b > 0.0)) {
      visit(a + (height_a / (height_a - height_b)) * (b - a));
    }
    if (height_b > 0.0) visit(b);
    a = b;
    height_a = height_b;
  }
  if (started) sum += edge_term(previous, first, normal);
  return sum;
}

}  // namespace

double point_to_polygon(const Eigen::Vector3d& point, const Eigen::Vector3d& normal,
                        std::span<const Loop> loops) {
  double sum = 0.0;
  for (const Loop& loop : loops) sum += loop_term(point, normal, loop);
  // A loop that runs counter-clockwise seen from the element runs clockwise about n.
  return -sum / (2.0 * std::numbers::pi);
}

double point_to_polygon(const Eigen::Vector3d& point, const Eigen::Vector3d& normal,
                        std::span<const Eigen::Vector3d> loop) {
  return -loop_term(point, normal, loop) / (2.0 * std::numbers::pi);
}

double point_to_sphere(const Eigen::Vector3d& point, const Eigen::Vector3d& normal,
                       const Eigen::Vector3d& center, double radius) {
  const Eigen::Vector3d to_center = center - point;
  const double distance = to_center.norm();
  if (!(distance > radius)) return 0.0;
  const double cos_theta = std::clamp(to_center.dot(normal) / distance, -1.0, 1.0);
  const double sin_alpha = radius / distance;
  const double sin2_alpha = sin_alpha * sin_alpha;
  if (cos_theta >= sin_alpha) return sin2_alpha * cos_theta;
  if (cos_theta <= -sin_alpha) return 0.0;
  const double sin_theta = std::sqrt(1.0 - cos_theta * cos_theta);
  const double x = std::sqrt(1.0 / sin2_alpha - 1.0);
  const double y = std::clamp(-x * cos_theta / sin_theta, -1.0, 1.0);
  const double s = sin_theta * std::sqrt(1.0 - y * y);
  const double over_pi = (cos_theta * std::acos(y) - x * s) * sin2_alpha + std::atan(s / x);
  return std::max(0.0, over_pi / std::numbers::pi);
}

}  // namespace lightwell
