#pragma once

#include <Eigen/Geometry>

namespace lightwell {

/// The rotation that takes the direction of `from` to that of `to`, about an axis at right angles
/// to both. Neither may be zero. Compiled once: Eigen decomposes a matrix here, which takes seconds
/// to compile.
Eigen::Quaterniond rotation_between(const Eigen::Vector3d& from, const Eigen::Vector3d& to);

}  // namespace lightwell
