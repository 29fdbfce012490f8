#include "radiosity/closed_forms/polygon_form_factor.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

namespace lightwell {
namespace {

// A vertex as seen from the point, and its distance.
struct SeenVertex {
  Eigen::Vector3d at;
  double distance;

  explicit SeenVertex(const Eigen::Vector3d& to) : at(to), distance(to.norm()) {}
};

// The angle between two directions, from its sine and cosine: arcsine where that is accurate, for
// edges that subtend almost nothing or almost 180 degrees, else arccosine. std::atan2 takes three
// times as long.
double angle_of(double sine, double cosine) {
  constexpr double half = std::numbers::sqrt2 / 2.0;
  if (sine > half) return std::acos(cosine);
  const double angle = std::asin(sine);
  return cosine > 0.0 ? angle : std::numbers::pi - angle;
}

// Gamma_k . n of the edge between points a and b as seen from the origin: the angle that the edge
// subtends times the unit normal of the plane through edge and origin.
double edge_term(const SeenVertex& a, const SeenVertex& b, const Eigen::Vector3d& normal) {
  const Eigen::Vector3d cross = a.at.cross(b.at);
  const double length = cross.norm();
  if (!(length > 0.0)) return 0.0;  // the edge points at the element: no angle
  const double scale = 1.0 / (a.distance * b.distance);
  return angle_of(length * scale, a.at.dot(b.at) * scale) * cross.dot(normal) / length;
}

// Sum of edge_term over the part of the loop above the horizon (Sutherland & Hodgman against one
// plane, without storing the clipped loop). A loop around the point, in the plane of the point but
// for rounding, would fill the hemisphere or nothing: such a loop gives nothing.
double loop_term(const Eigen::Vector3d& point, const Eigen::Vector3d& normal,
                 std::span<const Eigen::Vector3d> loop) {
  constexpr double in_plane = 1e-9;  // sine over the horizon
  double sum = 0.0;
  bool rises = false;
  std::optional<SeenVertex> first, previous;
  const auto visit = [&](const Eigen::Vector3d& to, double height) {
    const SeenVertex v(to);
    rises = rises || height > in_plane * v.distance;
    if (previous) {
      sum += edge_term(*previous, v, normal);
    } else {
      first = v;
    }
    previous = v;
  };
  Eigen::Vector3d a = loop.back() - point;
  double height_a = a.dot(normal);
  for (const Eigen::Vector3d& vertex : loop) {
    const Eigen::Vector3d b = vertex - point;
    const double height_b = b.dot(normal);
    if ((height_a > 0.0) != (height_b > 0.0)) {
      visit(a + (height_a / (height_a - height_b)) * (b - a), 0.0);
    }
    if (height_b > 0.0) visit(b, height_b);
    a = b;
    height_a = height_b;
  }
  if (previous) sum += edge_term(*previous, *first, normal);
  return rises ? sum : 0.0;
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
