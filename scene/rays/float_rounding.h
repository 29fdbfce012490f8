#pragma once

#include <Eigen/Geometry>
#include <limits>

namespace lightwell {

/// Rounding of a coordinate, metres, that is converted to float about the middle of a box with the
/// given diagonal, metres. (It is at most half as large; twice that is left for the sum of two.)
inline double float_rounding(double diagonal) {
  return 0.5 * diagonal * double{std::numeric_limits<float>::epsilon()};
}

/// Rounding of a ray's origin, of vertices and of their intersection together, metres.
inline double ray_rounding(double diagonal) {
  constexpr double roundings = 4.0;
  return roundings * float_rounding(diagonal);
}

/// The same for points and vertices in a box, of coordinates converted about `center`, metres.
inline double ray_rounding(const Eigen::AlignedBox3d& box, const Eigen::Vector3d& center) {
  const Eigen::Vector3d low = (box.min() - center).cwiseAbs();
  return ray_rounding(2.0 * low.cwiseMax((box.max() - center).cwiseAbs()).norm());
}

/// Largest height over a plane, in ray_rounding(), of a point that rays take as in the plane.
inline constexpr double coplanar_roundings = 4.0;

/// Cosine of the angle, 4.5e-5, by which rounding the vertices to float turns a facet at most,
/// unless the facet is a sliver: facets at smaller angles are parallel.
inline constexpr double parallel_cosine = 1.0 - 1e-9;

}  // namespace lightwell
