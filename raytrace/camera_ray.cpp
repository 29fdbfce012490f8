#include "raytrace/camera_ray.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

#include "raytrace/image.h"
#include "scene/errors.h"
#include "scene/sampling.h"

namespace lightwell {
namespace {

void check(const Camera& camera) {
  if (camera.width <= 0 || camera.height <= 0 ||
      std::int64_t{camera.width} * camera.height > max_image_pixels) {
    throw InputError(
        fmt::format("camera '{}': {} x {} pixels; both must be at least 1, and {} together at most",
                    camera.name, camera.width, camera.height, max_image_pixels));
  }
  validate(camera);
}

}  // namespace

CameraRays::CameraRays(const Camera& camera)
    : position_(camera.position),
      lens_radius_(camera.lens_radius),
      focus_distance_(camera.focus_distance),
      blades_(camera.blades) {
  check(camera);
  lens_right_ = lens_radius_ * camera.direction.cross(camera.up).normalized();
  lens_up_ = lens_radius_ * camera.up;
  const double half_width = std::tan(0.5 * camera.fov_degrees * std::numbers::pi / 180.0);
  const double pixel = 2.0 * half_width / camera.width;
  step_right_ = pixel * camera.direction.cross(camera.up).normalized();
  step_down_ = -pixel * camera.up;
  top_left_ =
      camera.direction - 0.5 * camera.width * step_right_ - 0.5 * camera.height * step_down_;
}

Ray CameraRays::ray(double x, double y) const {
  return {.origin = position_,
          .direction = (top_left_ + x * step_right_ + y * step_down_).normalized()};
}

Ray CameraRays::ray(double x, double y, double u, double v) const {
  if (!has_lens()) return ray(x, y);
  const Eigen::Vector2d at = lens_point(u, v);
  const Eigen::Vector3d from = at.x() * lens_right_ + at.y() * lens_up_;
  const Eigen::Vector3d sharp = focus_distance_ * (top_left_ + x * step_right_ + y * step_down_);
  return {.origin = position_ + from, .direction = (sharp - from).normalized()};
}

Eigen::Vector2d CameraRays::lens_point(double u, double v) const {
  if (blades_ == 0) {
    return cosine_direction(static_cast<float>(u), static_cast<float>(v)).head<2>();
  }
  // A point of one of the triangles between the centre and a side; the first corner is at the top.
  const double turn = u * blades_;
  const int blade = std::min(static_cast<int>(turn), blades_ - 1);
  const Eigen::Vector3d w = triangle_point(static_cast<float>(turn - blade), static_cast<float>(v));
  const auto corner = [&](int i) {
    const double angle = 2.0 * std::numbers::pi * i / blades_;
    return Eigen::Vector2d(std::sin(angle), std::cos(angle));
  };
  return w[1] * corner(blade) + w[2] * corner(blade + 1);
}

}  // namespace lightwell
