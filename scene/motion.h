#pragma once

#include <Eigen/Geometry>
#include <string>
#include <vector>

namespace lightwell {

/// Where something rigid is at a time: turned about the motion's axis, then moved.
struct MotionKey {
  double time = 0.0;     ///< s
  double degrees = 0.0;  ///< counter-clockwise seen against the axis; any number of turns
  Eigen::Vector3d translation = Eigen::Vector3d::Zero();  ///< m
};

/// How something rigid moves: evenly from key to key, angle and translation alike, and at rest
/// before the first and after the last.
struct RigidMotion {
  std::string name{};
  Eigen::Vector3d pivot = Eigen::Vector3d::Zero();  ///< m, a point of the axis
  Eigen::Vector3d axis = Eigen::Vector3d::UnitZ();  ///< unit
  std::vector<MotionKey> keys{};                    ///< two at least, times ascending
  /// When what moves is where its coordinates say, s.
  double rest_time = 0.0;

  /// From where its coordinates say to where it is at a time.
  Eigen::Isometry3d at(double time) const;
  /// From where a file puts it, to where it is at a time.
  Eigen::Isometry3d pose(double time) const;
};

/// What keeps a motion from being used ("has one key; give two at least, or leave the motion out"),
/// or empty.
std::string fault(const RigidMotion& motion);

}  // namespace lightwell
