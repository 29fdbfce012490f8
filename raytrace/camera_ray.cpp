#include "raytrace/camera_ray.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

#include "raytrace/image.h"
#include "scene/errors.h"

namespace lightwell {
namespace {

void check(const Camera& camera) {
  const auto fail = [&](const std::string& what) {
    throw InputError(fmt::format("camera '{}': {}", camera.name, what));
  };
  if (camera.width <= 0 || camera.height <= 0 ||
      std::int64_t{camera.width} * camera.height > max_image_pixels) {
    fail(fmt::format("{} x {} pixels; both must be at least 1, and {} together at most",
                     camera.width, camera.height, max_image_pixels));
  }
  if (!(camera.fov_degrees > 0.0 && camera.fov_degrees < 180.0)) {
    fail(fmt::format("a field of view of {} degrees; it must lie between 0 and 180",
                     camera.fov_degrees));
  }
  if (!camera.position.allFinite()) fail("its position is not finite");
  constexpr double tolerance = 1e-6;
  if (!(std::abs(camera.direction.norm() - 1.0) < tolerance) ||
      !(std::abs(camera.up.norm() - 1.0) < tolerance) ||
      !(std::abs(camera.direction.dot(camera.up)) < tolerance)) {
    fail("direction and up must be unit vectors at right angles to each other");
  }
}

}  // namespace

CameraRays::CameraRays(const Camera& camera) : position_(camera.position) {
  check(camera);
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

}  // namespace lightwell
