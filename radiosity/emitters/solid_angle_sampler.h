#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "radiosity/emitters/emitter.h"

namespace lightwell {

/// Samples of an emitting polygon close to a point, uniform in solid angle (Arvo 1995, "Stratified
/// sampling of spherical triangles"). Samples uniform in area would lie far away for the most part,
/// although the near parts give most of the light: the irradiance behind a slat before a window
/// would keep a noise of a fifth.
class SolidAngleSampler {
 public:
  SolidAngleSampler() = default;  ///< empty
  /// Empty where samples uniform in area serve as well: if the polygon fills less than 1 sr, if the
  /// point lies in its plane, or if it has many triangles.
  SolidAngleSampler(const Emitter& emitter, const Eigen::Vector3d& point);

  bool empty() const { return triangles_.empty(); }
  /// The solid angle of the polygon, sr; the sampler must not be empty.
  double solid_angle() const { return triangles_.back().up_to; }
  /// The vector from the point to a sample point of the polygon, metres, for (u, v) in [0,1)^2.
  Eigen::Vector3d to_point(double u, double v) const;

 private:
  // A spherical triangle, with the cosines of its sides and angles that samples need.
  struct Triangle {
    std::array<Eigen::Vector3d, 3> corner{};
    double solid_angle = 0.0, up_to = 0.0;  // sr; up_to adds the triangles before
    double cos_alpha = 0.0, sin_alpha = 0.0, alpha = 0.0, cos_c = 0.0;
  };
  std::vector<Triangle> triangles_{};
  Eigen::Vector3d normal_ = Eigen::Vector3d::UnitZ();
  double height_ = 0.0;  // m, from the point to the plane along its normal
};

}  // namespace lightwell
