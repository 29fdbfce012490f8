#include "raytrace/cameras/picture_plane.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "raytrace/cameras/fisheye.h"
#include "raytrace/cameras/lens_distortion.h"
#include "scene/degree.h"

namespace lightwell {
namespace {

using std::numbers::pi;

// Axes of a face of a cube: to the right, upwards, ahead.
struct Face {
  Eigen::Vector3d right, up, ahead;
};

// Faces of a cube in the order of the picture: left, ahead, right; behind, above, below. One who
// looks ahead and tilts the head sees the faces above and below.
const std::array<Face, 6>& cube_faces() {
  using V = Eigen::Vector3d;
  static const std::array<Face, 6> faces = {{
      {.right = V::UnitZ(), .up = V::UnitY(), .ahead = -V::UnitX()},
      {.right = V::UnitX(), .up = V::UnitY(), .ahead = V::UnitZ()},
      {.right = -V::UnitZ(), .up = V::UnitY(), .ahead = V::UnitX()},
      {.right = -V::UnitX(), .up = V::UnitY(), .ahead = -V::UnitZ()},
      {.right = V::UnitX(), .up = -V::UnitZ(), .ahead = V::UnitY()},
      {.right = V::UnitX(), .up = V::UnitZ(), .ahead = -V::UnitY()},
  }};
  return faces;
}

// Length on the plane that the whole picture is wide.
double plane_width(const Camera& camera) {
  const double angle = camera.fov_degrees * degree;
  switch (camera.projection) {
    case Projection::perspective:
      return 2.0 * std::tan(0.5 * angle);
    case Projection::orthographic:
      return camera.view_width;
    case Projection::cylindrical:
    case Projection::equirectangular:
    case Projection::stereo_panorama:
      return angle;
    case Projection::cube_map:
      return 2.0;
    case Projection::equidistant:
    case Projection::equisolid:
    case Projection::hemispherical:
    case Projection::stereographic:
      break;
  }
  return 2.0 * fisheye_radius(camera.projection, 0.5 * angle);
}

double circle_of(const Camera& camera) {
  if (!is_fisheye(camera.projection)) return std::numeric_limits<double>::infinity();
  const double angle = camera.circle_degrees > 0.0 ? camera.circle_degrees : camera.fov_degrees;
  return fisheye_radius(camera.projection, 0.5 * angle * degree);
}

Eigen::Vector3d from_longitude(double longitude, double elevation) {
  return {std::cos(elevation) * std::sin(longitude), std::sin(elevation),
          std::cos(elevation) * std::cos(longitude)};
}

double longitude_of(const Eigen::Vector3d& p) {
  return std::atan2(p.x(), p.z());
}

Eigen::Vector2d fisheye_place(Projection projection, const Eigen::Vector3d& p) {
  const double across = std::hypot(p.x(), p.y());
  if (across == 0.0) return Eigen::Vector2d::Zero();
  return fisheye_radius(projection, std::atan2(across, p.z())) / across * p.head<2>();
}

}  // namespace

double fisheye_radius(Projection projection, double theta) {
  switch (projection) {
    case Projection::equisolid:
      return 2.0 * std::sin(0.5 * theta);
    case Projection::hemispherical:
      return std::sin(theta);
    case Projection::stereographic:
      return 2.0 * std::tan(0.5 * theta);
    default:
      return theta;
  }
}

double fisheye_angle(Projection projection, double radius) {
  switch (projection) {
    case Projection::equisolid:
      return 2.0 * std::asin(0.5 * radius);
    case Projection::hemispherical:
      return std::asin(radius);
    case Projection::stereographic:
      return 2.0 * std::atan(0.5 * radius);
    default:
      return radius;
  }
}

PicturePlane::PicturePlane(const Camera& camera)
    : projection_(camera.projection),
      distortion_(camera.distortion),
      fold_(fold_radius(camera.distortion)),
      circle_(circle_of(camera)) {
  if (projection_ == Projection::cube_map) {
    columns_ = 3;
    rows_ = 2;
  } else if (projection_ == Projection::stereo_panorama) {
    rows_ = 2;
    half_separation_ = 0.5 * camera.eye_separation;
  }
  panel_width_ = static_cast<double>(camera.width) / columns_;
  panel_height_ = static_cast<double>(camera.height) / rows_;
  const double width = panel_width_ / camera.window.width();
  const double height = panel_height_ / camera.window.height();
  left_ = (camera.window.left - 0.5 + camera.shift.x()) * width;
  top_ = (camera.window.top - 0.5 - camera.shift.y()) * height;
  pixel_ = plane_width(camera) / width;
}

int PicturePlane::panel_at(double x, double y) const {
  const auto number = [](double at, double size, int count) {
    return std::clamp(static_cast<int>(std::floor(at / size)), 0, count - 1);
  };
  return number(y, panel_height_, rows_) * columns_ + number(x, panel_width_, columns_);
}

Eigen::Vector2d PicturePlane::place(double x, double y, int panel) const {
  const int column = panel % columns_, row = panel / columns_;
  return {pixel_ * (x - column * panel_width_ + left_), -pixel_ * (y - row * panel_height_ + top_)};
}

Eigen::Vector2d PicturePlane::picture_point(const Eigen::Vector2d& place, int panel) const {
  const int column = panel % columns_, row = panel / columns_;
  return {place.x() / pixel_ - left_ + column * panel_width_,
          -place.y() / pixel_ - top_ + row * panel_height_};
}

std::optional<Eigen::Vector2d> PicturePlane::without_distortion(
    const Eigen::Vector2d& place) const {
  if (distortion_.is_none()) return place;
  // Distortion is stated for y downwards.
  auto plain = undistorted(distortion_, {place.x(), -place.y()}, fold_);
  if (plain) plain->y() = -plain->y();
  return plain;
}

std::optional<Eigen::Vector3d> PicturePlane::direction(const Eigen::Vector2d& place,
                                                       int panel) const {
  switch (projection_) {
    case Projection::perspective: {
      const auto plain = without_distortion(place);
      if (!plain) return std::nullopt;
      return Eigen::Vector3d(plain->x(), plain->y(), 1.0).normalized();
    }
    case Projection::orthographic:
      return Eigen::Vector3d::UnitZ();
    case Projection::cylindrical:
      return Eigen::Vector3d(std::sin(place.x()), place.y(), std::cos(place.x())).normalized();
    case Projection::equirectangular:
    case Projection::stereo_panorama:
      return from_longitude(place.x(), place.y());
    case Projection::cube_map: {
      const Face& face = cube_faces()[static_cast<std::size_t>(panel)];
      return (face.ahead + place.x() * face.right + place.y() * face.up).normalized();
    }
    case Projection::equidistant:
    case Projection::equisolid:
    case Projection::hemispherical:
    case Projection::stereographic:
      break;
  }
  const double radius = place.norm();
  if (!(radius <= circle_)) return std::nullopt;
  if (radius == 0.0) return Eigen::Vector3d::UnitZ();
  const double theta = fisheye_angle(projection_, radius);
  const double across = std::sin(theta) / radius;
  return Eigen::Vector3d(across * place.x(), across * place.y(), std::cos(theta));
}

std::optional<Eigen::Vector2d> PicturePlane::place_of(const Eigen::Vector3d& point,
                                                      int panel) const {
  switch (projection_) {
    case Projection::perspective: {
      if (!(point.z() > 0.0)) return std::nullopt;
      const Eigen::Vector2d plain(point.x() / point.z(), -point.y() / point.z());
      if (!(plain.norm() <= fold_)) return std::nullopt;
      const Eigen::Vector2d shown = distorted(distortion_, plain);
      return Eigen::Vector2d(shown.x(), -shown.y());
    }
    case Projection::orthographic:
      return Eigen::Vector2d(point.head<2>());
    case Projection::cylindrical: {
      const double across = std::hypot(point.x(), point.z());
      if (!(across > 0.0)) return std::nullopt;
      return Eigen::Vector2d(longitude_of(point), point.y() / across);
    }
    case Projection::equirectangular:
    case Projection::stereo_panorama: {
      // Seen from an eye beside the middle, a point at the distance `across` turns by asin.
      const double across = std::hypot(point.x(), point.z());
      if (!(across >= half_separation_)) return std::nullopt;
      const double side = panel == 0 ? half_separation_ : -half_separation_;
      const double turn = half_separation_ > 0.0 ? std::asin(side / across) : 0.0;
      const double away = std::sqrt(across * across - side * side);
      return Eigen::Vector2d(std::remainder(longitude_of(point) + turn, 2.0 * pi),
                             std::atan2(point.y(), away));
    }
    case Projection::cube_map: {
      const Face& face = cube_faces()[static_cast<std::size_t>(panel)];
      const double ahead = point.dot(face.ahead);
      if (!(ahead > 0.0)) return std::nullopt;
      return Eigen::Vector2d(point.dot(face.right) / ahead, point.dot(face.up) / ahead);
    }
    case Projection::equidistant:
    case Projection::equisolid:
    case Projection::hemispherical:
    case Projection::stereographic:
      break;
  }
  if (projection_ == Projection::hemispherical && point.z() < 0.0) return std::nullopt;
  const Eigen::Vector2d place = fisheye_place(projection_, point);
  if (!(place.norm() <= circle_)) return std::nullopt;
  return place;
}

int PicturePlane::panel_of(const Eigen::Vector3d& direction) const {
  if (projection_ != Projection::cube_map) return 0;
  const auto& faces = cube_faces();
  const auto ahead = [&](const Face& face) { return direction.dot(face.ahead); };
  return static_cast<int>(std::ranges::max_element(faces, {}, ahead) - faces.begin());
}

Eigen::Vector3d PicturePlane::eye(const Eigen::Vector3d& direction, int panel) const {
  if (!(half_separation_ > 0.0)) return Eigen::Vector3d::Zero();
  const double longitude = longitude_of(direction);
  const double side = panel == 0 ? -half_separation_ : half_separation_;
  return {side * std::cos(longitude), 0.0, -side * std::sin(longitude)};
}

double PicturePlane::solid_angle_density(const Eigen::Vector2d& place) const {
  const auto cubed = [](double squared_tangent) { return std::pow(1.0 + squared_tangent, -1.5); };
  switch (projection_) {
    case Projection::perspective:
    case Projection::cube_map:
      return cubed(place.squaredNorm());
    case Projection::orthographic:
      return 0.0;
    case Projection::cylindrical:
      return cubed(place.y() * place.y());
    case Projection::equirectangular:
    case Projection::stereo_panorama:
      return std::max(0.0, std::cos(place.y()));
    case Projection::equisolid:
      return 1.0;
    case Projection::hemispherical:
      return 1.0 / std::sqrt(std::max(1e-12, 1.0 - place.squaredNorm()));
    case Projection::stereographic: {
      const double wide = 1.0 + 0.25 * place.squaredNorm();
      return 1.0 / (wide * wide);
    }
    case Projection::equidistant:
      break;
  }
  const double theta = place.norm();
  return theta > 0.0 ? std::max(0.0, std::sin(theta) / theta) : 1.0;
}

}  // namespace lightwell
