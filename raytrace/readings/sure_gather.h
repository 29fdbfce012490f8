#pragma once

#include <Eigen/Core>

#include "radiosity/gather/final_gather.h"

namespace lightwell {

/// Rays of sure_gather(): most of one set, and the number of sets.
constexpr int most_sure_rays = 1 << 16;  ///< hemisphere, sky
constexpr int sure_sets = 8;
constexpr int rays_over_set = 4;  ///< rays of the options over those of a set

/// Irradiance at points, with a bound of its noise.
struct SureIrradiance {
  BandArray irradiance{};  ///< direct and indirect light, points x bands, W/m^2
  /// Bound of the error of the point's illuminance, lx, with odds of about 19 to 1. NaN: neither a
  /// ray nor the solution found any light, so that nothing is known.
  Eigen::ArrayXd lux_within{};
  int missed = 0;  ///< points whose bound exceeds the accuracy
};

/// The error that a sure_gather() is to reach.
struct SureGoal {
  /// Bound as a share of each point's illuminance; 0: whatever the rays of the options leave.
  double accuracy = 0.0;
  /// Bound of the error of each point that is no noise, lx; empty: 0.
  Eigen::ArrayXd besides{};
};

/// A final gather whose noise is known.
///
/// Each point gathers `sure_sets` times with independent random numbers, a quarter of the rays of
/// `options` each. The result is the mean of the sets; with the standard deviation s of n sets,
///
///     bound = t s / sqrt(n)      t: Student's distribution, n - 1 degrees of freedom
///
/// separately for direct and for indirect light, whose squares add up, with the square of
/// `goal.besides`. Where a set of N rays found no indirect light at all, rays that find light are
/// rare, and s may be far too small. Then 3 / (n N) of the mean radiosity of the scene adds to the
/// bound: n N rays miss light that is rarer than that with odds of 19 to 1 (rule of three). Noise
/// of stratified rays falls with rays^(-3/4) where light varies little, so the mean of 8 sets of
/// N/4 rays has the noise of one set of N rays: (1/4)^(-3/4) / sqrt(8) = 1.
///
/// With `goal.accuracy` above 0, direct and indirect light are gathered again with more rays, other
/// random numbers and without the earlier rays, until the bound is at most that share of the
/// point's illuminance, or the rays reach `most_sure_rays` (`most_probe_shadow_rays` for emitters).
/// Noise is not brought below half of the accuracy where the error besides is greater.
/// Earlier rays that were kept would make the bound too small: rays stop where the bound happens to
/// be small.
///
/// Throws Interrupted when progress says stop. The same bits for any number of threads.
SureIrradiance sure_gather(const LitScene& lit, const BandArray& radiosity,
                           const GatherPoints& points, const GatherOptions& options,
                           const SureGoal& goal);

}  // namespace lightwell
