#pragma once

#include <Eigen/Core>

namespace lightwell {

/// A point that receives light, and the direction its differential element faces.
struct SurfacePoint {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< metres
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();   ///< unit
  /// Scene-wide number of the facet that holds the point, whose plane its rays exclude; -1: the
  /// point lies in free space.
  int facet = -1;
};

}  // namespace lightwell
