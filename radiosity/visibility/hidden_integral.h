#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "radiosity/visibility/shadowed_polygon.h"

namespace lightwell {

/// Integral over a triangle of F_hidden, the form factor from a point to what is hidden of a
/// polygon.
struct HiddenTriangle {
  std::array<Eigen::Vector3d, 3> corner;
  double hidden = 0.0;        ///< m^2
  double error = 0.0;         ///< estimated, m^2
  double least_error = 0.0;   ///< below which no agreement of rules brings it
  bool is_all_hidden = true;  ///< from all points of the rule
};

double total_error(std::span<const HiddenTriangle> triangles);

/// Integrates F_hidden over triangles of one polygon by Radon's rule (1948) of degree 5 with 7
/// points. The error is estimated by two rules of degree 2 on some of the points, by what the
/// corners see where all points see alike, and by the range of F_hidden where the edge of an umbra
/// or penumbra runs through. Keeps references to the blockers and to the parts of `to`.
class HiddenIntegral {
 public:
  HiddenIntegral(const ShaftEnd& from, const ShaftEnd& to, std::span<const Blocker> blockers);

  HiddenTriangle over(const std::array<Eigen::Vector3d, 3>& corner);

  /// Halves the worst triangle until the errors add up to `tolerance` (m^2) or there are 4096 of
  /// them.
  void refine(std::vector<HiddenTriangle>& triangles, double tolerance);

 private:
  double change_at_corners(const std::array<Eigen::Vector3d, 3>& corner, bool is_all_hidden);
  double missed_area(const std::array<Eigen::Vector3d, 3>& corner, std::uint32_t met) const;

  Eigen::Vector3d normal_;
  ShadowedPolygon view_;
  std::span<const Blocker> blockers_;
  std::vector<double> reach_area_;  // of `from`, per blocker
};

}  // namespace lightwell
