#include "viewer/window/walk_state.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

namespace lightwell {
namespace {

constexpr double run_factor = 3.0;
constexpr double turning_speed = 1.2;   ///< rad/s: half a turn in 2.6 s
constexpr double response_time = 0.08;  ///< tau, s: smooth without a noticeable delay
constexpr double closest_to_pole = 5.0 * std::numbers::pi / 180.0;

/// Returns the integral of `value` over `seconds` while `value` relaxes towards `wanted`:
///   v(t) = wanted + (v(0) - wanted) exp(-t / tau).
/// Updates `value`.
template <class T>
T relax(T& value, const T& wanted, double seconds) {
  const double left = std::exp(-seconds / response_time);
  const T covered = wanted * seconds + (value - wanted) * (response_time * (1.0 - left));
  value = wanted + (value - wanted) * left;
  return covered;
}

}  // namespace

WalkState::WalkState(const Camera& camera, const Eigen::Vector3d& up_axis, double walking_speed)
    : camera_(camera), up_axis_(up_axis), walking_speed_(walking_speed) {}

void WalkState::place(const Camera& camera) {
  camera_ = camera;
  velocity_.setZero();
  turning_ = 0.0;
}

Eigen::Vector3d WalkState::wanted_velocity(const WalkKeys& keys) const {
  const Eigen::Vector3d right = camera_.direction.cross(camera_.up);
  Eigen::Vector3d level = up_axis_.cross(right);
  // For an upright camera, `level` is the horizontal part of the line of sight. A camera rolled
  // onto its side has no level forward direction, and moves along the line of sight.
  if (level.norm() > 1e-3) {
    level.normalize();
  } else {
    level = camera_.direction;
  }
  Eigen::Vector3d way = (keys.forward - keys.back) * level + (keys.right - keys.left) * right +
                        (keys.up - keys.down) * up_axis_;
  if (way.norm() > 1.0) way.normalize();
  return way * (walking_speed_ * (keys.run ? run_factor : 1.0));
}

bool WalkState::advance(const WalkKeys& keys, double seconds) {
  if (!(seconds > 0.0)) return false;
  const Eigen::Vector3d covered = relax(velocity_, wanted_velocity(keys), seconds);
  const double turned =
      relax(turning_, (keys.turn_right - keys.turn_left) * turning_speed, seconds);
  // A thousandth of the speed is too slow to see, and counts as standing still: drawing can rest.
  if (velocity_.norm() < 1e-3 * walking_speed_) velocity_.setZero();
  if (std::abs(turning_) < 1e-3 * turning_speed) turning_ = 0.0;
  camera_.position += covered;
  if (turned != 0.0) look(turned, 0.0);
  return !covered.isZero(0.0) || turned != 0.0;
}

void WalkState::look(double yaw, double pitch) {
  turn(yaw, pitch);
}

void WalkState::orbit(const Eigen::Vector3d& pivot, double yaw, double pitch) {
  const Eigen::Matrix3d turned = turn(yaw, pitch);
  camera_.position = pivot + turned * (camera_.position - pivot);
  velocity_.setZero();
}

// Turns the eye and returns the rotation.
Eigen::Matrix3d WalkState::turn(double yaw, double pitch) {
  const double from_zenith = std::acos(std::clamp(camera_.direction.dot(up_axis_), -1.0, 1.0));
  // A camera that begins closer to the pole than the limit may stay, but not move closer.
  const double lowest = std::min(from_zenith, closest_to_pole);
  const double highest = std::max(from_zenith, std::numbers::pi - closest_to_pole);
  const double allowed_pitch = from_zenith - std::clamp(from_zenith - pitch, lowest, highest);

  const Eigen::Vector3d right = camera_.direction.cross(camera_.up);
  const Eigen::Matrix3d turn =
      (Eigen::AngleAxisd(-yaw, up_axis_) * Eigen::AngleAxisd(allowed_pitch, right.normalized()))
          .toRotationMatrix();
  camera_.direction = (turn * camera_.direction).normalized();
  const Eigen::Vector3d up = turn * camera_.up;
  camera_.up = (up - up.dot(camera_.direction) * camera_.direction).normalized();
  return turn;
}

void WalkState::dolly(double distance) {
  camera_.position += distance * camera_.direction;
}

}  // namespace lightwell
