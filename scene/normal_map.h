#pragma once

#include <Eigen/Core>

namespace lightwell {

/// Normals of the smooth surface that a facet stands for, over the facet's plane: gradient p +
/// offset, p in metres, which is of any length. As facets are planar, a linear map is all that
/// normals at corners and Phong's interpolation (1975) say, and whatever a facet is cut into or
/// joined with keeps it (see UvMap).
struct NormalMap {
  Eigen::Matrix3d gradient = Eigen::Matrix3d::Zero();  ///< 1/m
  Eigen::Vector3d offset = Eigen::Vector3d::Zero();

  Eigen::Vector3d at(const Eigen::Vector3d& p) const { return gradient * p + offset; }
};

}  // namespace lightwell
