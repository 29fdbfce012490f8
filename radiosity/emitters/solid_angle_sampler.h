#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "radiosity/emitters/direct_light.h"

namespace lightwell {

/// A polygon that emits, seen from a point close by: places of it are even in solid angle. Those
/// even in area would be far away for the most part, while what is near gives most of the light: a
/// slat before a window would be left with noise of a fifth of it.
class SolidAngleSampler {
 public:
  SolidAngleSampler() = default;  ///< nothing
  /// Nothing where places even in area do as well: below 1 sr, in the polygon's plane, and of
  /// polygons of many triangles.
  SolidAngleSampler(const Emitter& emitter, const Eigen::Vector3d& point);

  bool empty() const { return triangles_.empty(); }
  /// From the point to a place of the polygon, for (u, v) in [0,1)^2 (Arvo 1995, "Stratified
  /// sampling of spherical triangles").
  Eigen::Vector3d to_point(double u, double v) const;

 private:
  // Of unit directions, and its sides' and angles' cosines that samples need.
  struct Triangle {
    std::array<Eigen::Vector3d, 3> corner{};
    double solid_angle = 0.0, up_to = 0.0;  // the latter of this and those before
    double cos_alpha = 0.0, sin_alpha = 0.0, alpha = 0.0, cos_c = 0.0;
  };
  std::vector<Triangle> triangles_{};
  Eigen::Vector3d normal_ = Eigen::Vector3d::UnitZ();
  double height_ = 0.0;  // of the plane along its normal, from the point
};

}  // namespace lightwell
