#pragma once

#include <vector>

#include "radiosity/direct_light/lit_scene.h"
#include "radiosity/gather/final_gather.h"
#include "radiosity/solution/solution.h"

namespace lightwell {

/// An element, and the mean squared error of its interpolated irradiance relative to the squared
/// reference; below 0: not measured.
struct InnerError {
  int element = -1;
  double square = -1.0;
};

/// Points inside of an element at which errors are measured.
inline constexpr int inner_point_count = 4;

/// Point k of an element: in the middle of a quarter of a quadrilateral, half-way from the centre
/// of a triangle to a corner, or in its centre.
Eigen::Vector3d inner_position(const PatchMesh& mesh, int element, int k);

/// Effort of measure_inside().
struct InnerEffort {
  int most = 0;                  ///< elements that are measured one by one
  int rays = 64;                 ///< rays of the hemisphere at each point
  bool counts_noise = true;      ///< whether the noise of these rays counts as an error
  std::uint64_t replica = 4000;  ///< keeps the random numbers apart from those of other gathers
  /// Result of gatherable_radiosity() for the solution; null: found here.
  const BandArray* radiosity = nullptr;
};

/// Measures squared errors of elements: irradiance is gathered at the points inside and compared
/// with the interpolated one, both without caustics, which no gather at a point finds. Elements
/// whose reference is 0 have no error.
///
/// At most `effort.most` elements are measured, and fewer where lights are many: two million rays
/// of hemispheres and towards lamps, beside those towards the sky. Every second, third, ... element
/// is measured where there are more. The squares of the others follow the squared range of their
/// corners' irradiance, by the ratio of those of their surface that are measured.
///
/// The caster of `lit` is of the solution's mesh; `gather` decides the shadow rays. Throws
/// Interrupted when progress says stop.
void measure_inside(const LitScene& lit, const GatherOptions& gather,
                    const RadiositySolution& solution, const InnerEffort& effort,
                    std::vector<InnerError>& elements);

/// Raises RadiositySolution::interpolation_error to the roots of the measured squares.
void raise_to_measured(const std::vector<InnerError>& elements, RadiositySolution& solution);

}  // namespace lightwell
