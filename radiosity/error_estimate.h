#pragma once

#include <span>
#include <vector>

#include "mesh/elements/element_caster.h"
#include "radiosity/direct_light/direct_light.h"
#include "radiosity/direct_light/lit_scene.h"
#include "radiosity/solve.h"

namespace lightwell {

/// An estimated error of interpolated irradiance, relative to error_reference().
struct ErrorEstimate {
  double square = 0.0;     ///< mean squared error over the sample points
  double deviation = 0.0;  ///< standard error of `square`
  double noise = 0.0;      ///< RMS noise that the rays of both gathers leave in the error
  int batches = 0;         ///< batches of sample points

  double error() const;  ///< upper end: sqrt(square + deviation)
  double least() const;  ///< lower end: sqrt(square - deviation), at least 0
};

/// Sample points and parts of an estimate by estimate_errors(), and light that is known beforehand.
struct EstimateTask {
  /// Batches, from 0, have other sample points and rays.
  int batch = 0;
  /// Gets the estimated RMS error of interpolation over each element, for solutions that were not
  /// refined: proportional to the range of the corners' irradiance (plus 5 %, in the square), and
  /// scaled to the mean square of the errors beyond the noise of both gathers. Unchanged if there
  /// are no sample points or no light. Null: not wanted.
  Eigen::ArrayXf* of_elements = nullptr;
  /// Parts for which this is 0 are left out; empty: none.
  std::span<const char> wanted{};
  /// Result of gatherable_radiosity() for the solution, which takes seconds for coats, shared by
  /// several batches. Null: found for this one.
  const BandArray* radiosity = nullptr;
};

/// Relative RMS error of interpolated irradiance over the judged_patches() of each part, compared
/// with independent gathers at random sample points.
///
/// - Parts: those of the solution, in their order, each relative to its own mean (see PartMeans).
///   A part without light, or without a surface that reflects, has no batches.
/// - Sample points: `options.error_points` or more (see estimate_points), shared by area. Each part
///   has at least 128, or twice the points over the number of parts if that is less (16 at least).
///   Half are uniform over the part's area. Half are drawn in proportion to the squared error that
///   refinement leaves in the elements, or, without refinement, to the squared range of the
///   elements' corners (importance sampling).
/// - Gathers: at least twice the rays of the solution's (see estimate_rays), and other random
///   numbers.
/// - Shared error: the gathers read the solution's own light. If that light is too bright or too
///   dim in all, for example since interpolation cuts peaks off, then so are the gathers, by the
///   reflected share of all light. This part is corrected, in each part of the scene by itself.
/// - Noise of both gathers is left in, which makes up for the other errors that both share.
///
/// The caster of `lit` is of the solution's mesh. Throws Interrupted when progress says stop.
std::vector<ErrorEstimate> estimate_errors(const LitScene& lit, const SolveOptions& options,
                                           const RadiositySolution& solution,
                                           const EstimateTask& task = {});

/// The estimate by the sample points of both, whose batches have the same size; either may be
/// empty.
ErrorEstimate joined(const ErrorEstimate& a, const ErrorEstimate& b);

}  // namespace lightwell
