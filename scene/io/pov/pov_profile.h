#pragma once

#include <Eigen/Core>
#include <vector>

namespace lightwell {

/// Curve through the points of a profile.
enum class PovCurve {
  linear,
  quadratic,       ///< parabolas; the first point gives the first direction alone
  cubic,           ///< Catmull & Rom 1974; the first and the last point give directions alone
  bezier,          ///< four points for each piece
  squared_radius,  ///< the square of x is cubic in y; the first and the last point as for `cubic`
};

/// Points on the curve: the ends of its pieces, and for all but linear curves seven between them.
/// Empty for too few points. Points are (x, y); of `squared_radius`, y should not stay the same
/// between points.
std::vector<Eigen::Vector2d> pov_profile(PovCurve curve,
                                         const std::vector<Eigen::Vector2d>& points);

}  // namespace lightwell
