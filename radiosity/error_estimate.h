#pragma once

#include "mesh/elements/element_caster.h"
#include "radiosity/emitters/direct_light.h"
#include "radiosity/emitters/lit_scene.h"
#include "radiosity/solve.h"

namespace lightwell {

/// An estimated error of interpolated irradiance, relative to error_reference().
struct ErrorEstimate {
  double square = 0.0;     ///< mean squared error over the sample points
  double deviation = 0.0;  ///< standard error of `square`
  double noise = 0.0;      ///< RMS noise that the rays of both gathers leave in the error
  int batches = 1;         ///< batches of sample points

  double error() const;  ///< upper end: sqrt(square + deviation)
  double least() const;  ///< lower end: sqrt(square - deviation), at least 0
};

/// Relative RMS error of interpolated irradiance over the area of judged_patches(), compared with
/// independent gathers at random sample points.
///
/// - Sample points: `options.error_points` or more (see estimate_points). Half are uniform over the
///   area. Half are drawn in proportion to the squared error that refinement leaves in the
///   elements, or, without refinement, to the squared range of the elements' corners (importance
///   sampling).
/// - Gathers: at least twice the rays of the solution's (see estimate_rays), and other random
///   numbers.
/// - Shared error: the gathers read the solution's own light. If that light is too bright or too
///   dim in all, for example since interpolation cuts peaks off, then so are the gathers, by the
///   reflected share of all light. This part is corrected.
/// - Noise of both gathers is left in, which makes up for the other errors that both share.
///
/// The caster of `lit` is of the solution's mesh. `of_elements`, if given, gets the estimated RMS
/// error of interpolation over each element, for solutions that were not refined: proportional to
/// the range of the corners' irradiance (plus 5 %, in the square), and scaled to the mean square of
/// the errors beyond the noise of both gathers. `of_elements` is left unchanged if there are no
/// sample points or no light. Each `batch`, from 0, has other sample points and rays. Throws
/// Interrupted when progress says stop.
ErrorEstimate estimate_error(const LitScene& lit, const SolveOptions& options,
                             const RadiositySolution& solution,
                             Eigen::ArrayXf* of_elements = nullptr, int batch = 0);

/// The estimate by the sample points of both, whose batches have the same size.
ErrorEstimate joined(const ErrorEstimate& a, const ErrorEstimate& b);

}  // namespace lightwell
