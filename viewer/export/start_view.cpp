#include "viewer/export/start_view.h"
#include "mesh/patches/mesh_bounds.h"

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

namespace lightwell {
namespace {

constexpr double outside_fov_degrees = 40.0;
constexpr double inside_fov_degrees = 75.0;
/// Least share of lit pixels in a picture from outside; below this share the scene counts as a
/// closed room.
constexpr double lit_share = 0.15;
constexpr int coarse_width = 48;

Camera look_along(const Eigen::Vector3d& position, const Eigen::Vector3d& direction,
                  const Eigen::Vector3d& up_axis, double fov_degrees, int width, int height) {
  Camera camera;
  camera.position = position;
  camera.direction = direction.normalized();
  Eigen::Vector3d right = camera.direction.cross(up_axis);
  if (right.norm() < 1e-3) right = camera.direction.unitOrthogonal();
  camera.up = right.normalized().cross(camera.direction).normalized();
  camera.fov_degrees = fov_degrees;
  camera.width = width;
  camera.height = height;
  return camera;
}

double share_of_light(const Image& image) {
  int lit = 0;
  for (Eigen::Index i = 0; i < image.radiance.rows(); ++i) {
    lit += (image.radiance.row(i) > 0.0f).any();
  }
  return static_cast<double>(lit) / static_cast<double>(image.radiance.rows());
}

}  // namespace

Eigen::Vector3d guess_up_axis(const std::vector<Camera>& cameras, const Bounds& bounds) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  // Plans and sky domes look along what is up.
  for (const Camera& camera : cameras) {
    const bool may_look_up =
        camera.projection == Projection::orthographic || is_fisheye(camera.projection);
    if (!may_look_up) sum += camera.up;
  }
  if (sum.norm() > 1e-6) {
    int axis = 0;
    sum.cwiseAbs().maxCoeff(&axis);
    return Eigen::Vector3d::Unit(axis) * (sum[axis] < 0.0 ? -1.0 : 1.0);
  }
  const Eigen::Vector3d size = bounds.high - bounds.low;
  return size.z() < size.y() ? Eigen::Vector3d::UnitZ() : Eigen::Vector3d::UnitY();
}

Camera frame_all(const Bounds& bounds, const Eigen::Vector3d& direction,
                 const Eigen::Vector3d& up_axis, int width, int height) {
  const double half_width = std::tan(outside_fov_degrees * std::numbers::pi / 360.0);
  const double half_height = half_width * height / width;
  const double sine = std::sin(std::atan(std::min(half_width, half_height)));
  const double distance = 0.5 * bounds.diagonal() / sine;
  const Eigen::Vector3d center = 0.5 * (bounds.low + bounds.high);
  return look_along(center - distance * direction.normalized(), direction, up_axis,
                    outside_fov_degrees, width, height);
}

Camera fit_to_window(const Camera& camera, int width, int height) {
  const double own_aspect = static_cast<double>(camera.width) / camera.height;
  const double wider = static_cast<double>(width) / height / own_aspect;
  Camera fitted = camera;
  fitted.width = width;
  fitted.height = height;
  fitted.shift.x() /= std::max(1.0, wider);
  fitted.shift.y() *= std::min(1.0, wider);
  if (wider > 1.0 && camera.projection == Projection::orthographic) {
    fitted.view_width *= wider;
  } else if (wider > 1.0) {
    const double half_width = wider * std::tan(camera.fov_degrees * std::numbers::pi / 360.0);
    fitted.fov_degrees = std::atan(half_width) * 360.0 / std::numbers::pi;
  }
  return fitted;
}

Camera find_start(const ElementCaster& caster, const std::vector<ElementKind>& kinds,
                  const BandArray& radiance, const Eigen::Vector3d& up_axis, int width,
                  int height) {
  const Bounds bounds = mesh_bounds(caster.mesh());
  const Eigen::Vector3d side = up_axis.unitOrthogonal();
  const Eigen::Vector3d front = up_axis.cross(side);
  Camera best = frame_all(bounds, front, up_axis, width, height);
  double best_share = lit_share;
  // Open boxes may face any way; a steeper view from above is tried as well.
  const std::array<Eigen::Vector3d, 6> ways = {
      Eigen::Vector3d(front), -front, side, -side, (front - up_axis), (side - front - 2 * up_axis)};
  for (const Eigen::Vector3d& way : ways) {
    const Camera camera = frame_all(bounds, way, up_axis, width, height);
    const double share =
        share_of_light(coarse_picture(caster, kinds, radiance, camera, coarse_width));
    // A direction replaces the best so far only with more than 20 % more lit pixels.
    if (share > 1.2 * best_share) {
      best = camera;
      best_share = share;
    }
  }
  if (best_share > lit_share) return best;

  const Eigen::Vector3d center = 0.5 * (bounds.low + bounds.high);
  const Eigen::Vector3d half = 0.5 * (bounds.high - bounds.low);
  for (const double sign : {1.0, -1.0}) {
    const Eigen::Vector3d way = (sign * front + 0.6 * side).normalized();
    const Eigen::Vector3d offset = 0.8 * half.cwiseProduct(way);
    const Camera camera =
        look_along(center - offset, offset, up_axis, inside_fov_degrees, width, height);
    const double share =
        share_of_light(coarse_picture(caster, kinds, radiance, camera, coarse_width));
    if (share > best_share) {
      best = camera;
      best_share = share;
    }
  }
  return best;
}

}  // namespace lightwell
