#pragma once

#include <Eigen/Core>

#include "scene/scene.h"

namespace lightwell {

/// Which movements are asked for at the moment.
struct WalkKeys {
  bool forward = false, back = false, left = false, right = false, up = false, down = false;
  bool turn_left = false, turn_right = false;
  bool run = false;
};

/// A person with a camera walking through the scene. Steps follow the exact solution of
/// dv/dt = (v_wanted - v) / tau, so that where a walk ends does not depend on the frame rate.
class WalkState {
 public:
  /// `up_axis` (unit) is what turning turns about and walking keeps level; `walking_speed` in m/s.
  WalkState(const Camera& camera, const Eigen::Vector3d& up_axis, double walking_speed);

  const Camera& camera() const { return camera_; }
  /// Stands still at another camera.
  void place(const Camera& camera);

  /// Moves on for `seconds`; false if nothing moved. Forward is level, whatever the pitch.
  bool advance(const WalkKeys& keys, double seconds);

  /// Turns the eye, radians: `yaw` to the right, `pitch` upwards, as far as 5 degrees from the
  /// zenith or the nadir.
  void look(double yaw, double pitch);

  /// The same about a point: the eye goes around it, and what it looked at stays in view.
  void orbit(const Eigen::Vector3d& pivot, double yaw, double pitch);

  /// Moves along the line of sight, metres.
  void dolly(double distance);

  /// Puts the eye where it came to, on foot; speed and direction stay.
  void move_eye_to(const Eigen::Vector3d& position) { camera_.position = position; }

 private:
  Eigen::Matrix3d turn(double yaw, double pitch);
  Eigen::Vector3d wanted_velocity(const WalkKeys& keys) const;

  Camera camera_;
  Eigen::Vector3d up_axis_;
  double walking_speed_;
  Eigen::Vector3d velocity_ = Eigen::Vector3d::Zero();  ///< m/s
  double turning_ = 0.0;                                ///< rad/s, to the right
};

}  // namespace lightwell
