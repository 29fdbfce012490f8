#pragma once

#include <Eigen/Core>

#include "scene/scene.h"

namespace lightwell {

/// Movements whose keys are held down.
struct WalkKeys {
  bool forward = false, back = false, left = false, right = false, up = false, down = false;
  bool turn_left = false, turn_right = false;
  bool run = false;
};

/// A camera that a person moves through the scene. Steps follow the exact solution of
/// dv/dt = (v_wanted - v) / tau, so that the end of a walk does not depend on the frame rate.
class WalkState {
 public:
  /// `up_axis`: unit, the axis of yaw and the normal of level walking. `walking_speed`: m/s.
  WalkState(const Camera& camera, const Eigen::Vector3d& up_axis, double walking_speed);

  const Camera& camera() const { return camera_; }
  /// Moves to another camera, with speed 0.
  void place(const Camera& camera);

  /// Moves for `seconds`. Returns false if nothing moved. Forward is level for any pitch.
  bool advance(const WalkKeys& keys, double seconds);

  /// Turns the eye, radians: `yaw` to the right, `pitch` upwards, as far as 5 degrees from the
  /// zenith or the nadir.
  void look(double yaw, double pitch);

  /// Turns the eye as look() does, and moves the eye by the same rotation about `pivot`.
  void orbit(const Eigen::Vector3d& pivot, double yaw, double pitch);

  /// Moves along the line of sight by `distance`, m.
  void dolly(double distance);

  /// Sets the position of the eye, m. Speed and direction stay.
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
