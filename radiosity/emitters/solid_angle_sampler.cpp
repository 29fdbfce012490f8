#include "radiosity/emitters/solid_angle_sampler.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace lightwell {
namespace {

using Eigen::Vector3d;

// The solid angle of a triangle (Van Oosterom & Strackee 1983, "The solid angle of a plane
// triangle").
double solid_angle_of(const Vector3d& a, const Vector3d& b, const Vector3d& c) {
  return 2.0 * std::atan2(std::abs(a.dot(b.cross(c))), 1.0 + a.dot(b) + b.dot(c) + c.dot(a));
}

Vector3d across(const Vector3d& of, const Vector3d& axis) {
  return (of - of.dot(axis) * axis).normalized();
}

Vector3d towards(const Vector3d& axis, const Vector3d& beside, double cosine) {
  return cosine * axis + std::sqrt(std::max(0.0, 1.0 - cosine * cosine)) * beside;
}

}  // namespace

SolidAngleSampler::SolidAngleSampler(const Emitter& emitter, const Vector3d& point) {
  constexpr std::size_t most_triangles = 32;
  constexpr double large = 1.0;  // sr
  constexpr double in_plane = 1e-3;
  if (emitter.is_sphere || emitter.triangles.size() > most_triangles) return;
  normal_ = emitter.normal;
  height_ = (emitter.loops[0][0] - point).dot(normal_);
  // A polygon fills at most area / height^2 of solid angle.
  const double square = height_ * height_;
  if (large * square > emitter.area || square < in_plane * in_plane * emitter.area) return;
  // Nor does it fill more than area height / r^3, with the distance r of its nearest point.
  const double nearest = (emitter.center - point).norm() - emitter.radius;
  if (nearest > 0.0 && large * nearest * nearest * nearest > emitter.area * std::abs(height_)) {
    return;
  }
  double sum = 0.0;
  for (const auto& corners : emitter.triangles) {
    const Vector3d a = (corners[0] - point).normalized(), b = (corners[1] - point).normalized(),
                   c = (corners[2] - point).normalized();
    Triangle triangle{.corner = {a, b, c}, .solid_angle = solid_angle_of(a, b, c)};
    if (!(triangle.solid_angle > 0.0)) continue;
    triangle.up_to = sum += triangle.solid_angle;
    triangle.cos_c = a.dot(b);
    triangle.cos_alpha = std::clamp(across(b, a).dot(across(c, a)), -1.0, 1.0);
    triangle.alpha = std::acos(triangle.cos_alpha);
    triangle.sin_alpha = std::sin(triangle.alpha);
    triangles_.push_back(triangle);
  }
  if (sum < large) triangles_.clear();
}

Vector3d SolidAngleSampler::to_point(double u, double v) const {
  const double wanted = u * triangles_.back().up_to;
  std::size_t i = 0;
  while (i + 1 < triangles_.size() && wanted >= triangles_[i].up_to) ++i;
  const Triangle& t = triangles_[i];
  // The part of the triangle's solid angle on b's side of the arc from b to a point on side ac.
  const double part =
      std::clamp(wanted - (i == 0 ? 0.0 : triangles_[i - 1].up_to), 0.0, t.solid_angle);
  const auto& [a, b, c] = t.corner;
  const double sine = std::sin(part - t.alpha), cosine = std::cos(part - t.alpha);
  const double p = cosine - t.cos_alpha, q = sine + t.sin_alpha * t.cos_c;
  const double below = (q * sine + p * cosine) * t.sin_alpha;
  const double cos_on_side =
      below != 0.0 ? std::clamp(((q * cosine - p * sine) * t.cos_alpha - q) / below, a.dot(c), 1.0)
                   : 1.0;
  const Vector3d on_side = towards(a, across(c, a), cos_on_side);
  const Vector3d direction = towards(b, across(on_side, b), 1.0 - v * (1.0 - on_side.dot(b)));
  return height_ / direction.dot(normal_) * direction;
}

}  // namespace lightwell
