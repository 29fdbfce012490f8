#pragma once

#include <Eigen/Core>

namespace lightwell {

/// Normals of the smooth surface that a facet approximates, over the facet's plane: gradient p +
/// offset, p in metres, of any length. Facets are planar, so a linear map holds everything that
/// normals at corners and Phong's interpolation (1975) define. Facets that are cut or joined keep
/// their map (see UvMap).
struct NormalMap {
  Eigen::Matrix3d gradient = Eigen::Matrix3d::Zero();  ///< 1/m
  Eigen::Vector3d offset = Eigen::Vector3d::Zero();

  Eigen::Vector3d at(const Eigen::Vector3d& p) const { return gradient * p + offset; }
};

}  // namespace lightwell
