#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "radiosity/visibility/shadowed_polygon.h"

namespace lightwell {

/// Integral over a triangle of F_hidden(x), the form factor from point x to the hidden part of a
/// polygon.
struct HiddenTriangle {
  std::array<Eigen::Vector3d, 3> corner;
  double hidden = 0.0;        ///< m^2
  double error = 0.0;         ///< estimated, m^2
  double least_error = 0.0;   ///< lower bound of `error` however well rules agree, m^2
  bool is_all_hidden = true;  ///< all of the polygon is hidden from every point of the rule
};

double total_error(std::span<const HiddenTriangle> triangles);

/// Integrates F_hidden over triangles of one polygon by Radon's rule (1948) of degree 5 with 7
/// points. Keeps references to the blockers and to the parts of `to`. Terms of the error estimate:
///   - the larger difference from two rules of degree 2 on some of the points;
///   - the area within reach of blockers that no point of the rule meets;
///   - the change towards the corners where the points of the rule all see everything, or all
///     nothing;
///   - at least 1 % of area times range of F_hidden where the edge of an umbra or penumbra crosses
///     the triangle.
class HiddenIntegral {
 public:
  HiddenIntegral(const ShaftEnd& from, const ShaftEnd& to, std::span<const Blocker> blockers);

  /// The integral over one triangle.
  HiddenTriangle over(const std::array<Eigen::Vector3d, 3>& corner);

  /// Halves the triangle of the largest error until the errors add up to at most `tolerance` (m^2)
  /// or there are 4096 triangles.
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
