#pragma once

#include <Eigen/Geometry>
#include <string>
#include <vector>

namespace lightwell {

/// Pose of a rigid body at a time: a turn about the motion's axis, then a translation.
struct MotionKey {
  double time = 0.0;     ///< s
  double degrees = 0.0;  ///< counter-clockwise seen against the axis; any number of turns
  Eigen::Vector3d translation = Eigen::Vector3d::Zero();  ///< m
};

/// Motion of a rigid body. Angle and translation are linear between keys; the body rests before the
/// first key and after the last.
struct RigidMotion {
  std::string name{};
  Eigen::Vector3d pivot = Eigen::Vector3d::Zero();  ///< m, a point of the axis
  Eigen::Vector3d axis = Eigen::Vector3d::UnitZ();  ///< unit
  std::vector<MotionKey> keys{};                    ///< two at least, times ascending
  /// Time at which the body stands where the scene's coordinates have it, s.
  double rest_time = 0.0;

  /// Transformation from the scene's coordinates to the body's pose at `time`, s.
  Eigen::Isometry3d at(double time) const;
  /// Transformation from the file's coordinates to the body's pose at `time`, s.
  Eigen::Isometry3d pose(double time) const;
};

/// Fault that keeps a motion from being used ("has one key; give two at least, or leave the motion
/// out"); empty if there is none.
std::string fault(const RigidMotion& motion);

}  // namespace lightwell
