#pragma once

#include <functional>
#include <vector>

#include "scene/progress.h"
#include "scene/round_shape.h"
#include "scene/surface_point.h"

namespace lightwell {

/// Returns whether a ray ends where a form factor counts it: `facet` is the shape that it meets
/// (-1: none), `end` the place.
using RayEnd = std::function<bool(int facet, const Eigen::Vector3d& end)>;

/// Shapes between which rays are cast; one facet each.
struct RoundRays {
  std::vector<RoundShape> shapes{};
  bool from_back = false;  ///< rays leave the back of shape 0, such as the inside of a sphere
  RayEnd counts{};
};

/// Share of the rays from shape 0 that count, cosine-distributed over the whole side, [0,1]. All
/// patches of the side cast as many.
double round_form_factor(const RoundRays& rays, const Progress& progress);

/// The same from a differential element.
double element_form_factor(const RoundRays& rays, const SurfacePoint& element);

/// Bound of the error of a share of scrambled Sobol points in four dimensions: three times n^-0.75,
/// their usual error, for the n = 2^17 points of a patch.
inline constexpr double round_ray_error = 3.0 * 0x1p-12 * 0.5946;

}  // namespace lightwell
