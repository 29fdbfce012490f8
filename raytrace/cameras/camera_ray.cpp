#include "raytrace/cameras/camera_ray.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

#include "raytrace/pictures/image.h"
#include "scene/errors.h"
#include "scene/sampling.h"

namespace lightwell {
namespace {

const Camera& checked(const Camera& camera) {
  if (camera.width <= 0 || camera.height <= 0 ||
      std::int64_t{camera.width} * camera.height > max_image_pixels) {
    throw InputError(
        fmt::format("camera '{}': {} x {} pixels; both must be at least 1, and {} together at most",
                    camera.name, camera.width, camera.height, max_image_pixels));
  }
  validate(camera);
  return camera;
}

}  // namespace

CameraRays::CameraRays(const Camera& camera)
    : plane_(checked(camera)),
      position_(camera.position),
      near_(camera.near_distance),
      far_(camera.far_distance),
      lens_radius_(camera.lens_radius),
      focus_distance_(camera.focus_distance),
      blades_(camera.blades) {
  axes_ << camera.direction.cross(camera.up).normalized(), camera.up, camera.direction;
}

// The ray from a point of the camera's frame, cut to what is neither too near nor too far.
Ray CameraRays::ray_from(const Eigen::Vector3d& eye, const Eigen::Vector3d& direction) const {
  const double along = is_flat(plane_.projection()) ? direction.z() : 1.0;
  Ray ray{.origin = position_, .direction = (axes_ * direction).normalized()};
  if (!eye.isZero(0.0)) ray.origin += axes_ * eye;
  if (near_ > 0.0) ray.origin += near_ / along * ray.direction;
  ray.t_max = (far_ - near_) / along;
  return ray;
}

std::optional<Ray> CameraRays::ray_at(double x, double y, int panel) const {
  const Eigen::Vector2d place = plane_.place(x, y, panel);
  const auto direction = plane_.direction(place, panel);
  if (!direction) return std::nullopt;
  const bool is_parallel = plane_.projection() == Projection::orthographic;
  return ray_from(
      is_parallel ? Eigen::Vector3d(place.x(), place.y(), 0.0) : plane_.eye(*direction, panel),
      *direction);
}

std::optional<Ray> CameraRays::ray_at(double x, double y, double u, double v, int panel) const {
  if (!has_lens()) return ray_at(x, y, panel);
  const auto plain = plane_.without_distortion(plane_.place(x, y, panel));
  if (!plain) return std::nullopt;
  const Eigen::Vector2d at = lens_radius_ * lens_point(u, v);
  const Eigen::Vector3d from(at.x(), at.y(), 0.0);
  const Eigen::Vector3d sharp = focus_distance_ * Eigen::Vector3d(plain->x(), plain->y(), 1.0);
  return ray_from(from, (sharp - from).normalized());
}

PixelCone CameraRays::cone(double x, double y, int panel) const {
  const double pixel = plane_.pixel();
  switch (plane_.projection()) {
    case Projection::orthographic:
      return {.start = pixel};
    case Projection::perspective:
      return {.start = near_ * pixel, .spread = pixel};
    default:
      break;
  }
  const double spread = pixel * std::sqrt(plane_.solid_angle_density(plane_.place(x, y, panel)));
  return {.start = near_ * spread, .spread = spread};
}

std::optional<Eigen::Vector2d> CameraRays::picture_point(const Eigen::Vector3d& point,
                                                         int panel) const {
  const Eigen::Vector3d seen = axes_.transpose() * (point - position_);
  if (plane_.projection() == Projection::cube_map) panel = plane_.panel_of(seen);
  const auto place = plane_.place_of(seen, panel);
  if (!place) return std::nullopt;
  return plane_.picture_point(*place, panel);
}

double CameraRays::depth(const Eigen::Vector3d& point) const {
  const Eigen::Vector3d way = point - position_;
  return is_flat(plane_.projection()) ? way.dot(axes_.col(2)) : way.norm();
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
