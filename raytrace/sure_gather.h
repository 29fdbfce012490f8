#pragma once

#include <Eigen/Core>

#include "radiosity/gather/final_gather.h"

namespace lightwell {

/// Limits of sure_gather(): rays of one set, of which there are `sure_sets`.
constexpr int most_sure_rays = 1 << 16;  ///< hemisphere, sky
constexpr int sure_sets = 8;

/// Irradiance at points, with a bound of its noise.
struct SureIrradiance {
  BandArray irradiance{};  ///< direct and indirect light, points x bands, W/m^2
  /// Bound of the noise of the point's illuminance, lx, with odds of about 19 to 1. NaN: no ray
  /// found any light, so that nothing is known.
  Eigen::ArrayXd lux_within{};
  int missed = 0;  ///< points whose rays reached the limit before the accuracy
};

/// A final gather whose noise is known.
///
/// Each point gathers `sure_sets` times with independent random numbers, a quarter of the rays of
/// `options` each. The result is the mean of the sets; with the standard deviation s of n sets,
///
///     bound = t s / sqrt(n)      t: Student's distribution, n - 1 degrees of freedom
///
/// separately for direct and for indirect light, whose squares add up. Noise of stratified rays
/// falls with rays^(-3/4) where light varies little, so the mean of 8 sets of N/4 rays has the
/// noise of one set of N rays: (1/4)^(-3/4) / sqrt(8) = 1.
///
/// With `accuracy` above 0, direct and indirect light are gathered again with more rays, other
/// random numbers and without the earlier rays, until the bound is at most that share of the
/// point's illuminance, or the rays reach `most_sure_rays` (`most_probe_shadow_rays` for emitters).
/// Earlier rays that were kept would make the bound too small: rays stop where the bound happens to
/// be small.
///
/// Throws Interrupted when progress says stop. The same bits for any number of threads.
SureIrradiance sure_gather(const LitScene& lit, const BandArray& radiosity,
                           const GatherPoints& points, const GatherOptions& options,
                           double accuracy);

}  // namespace lightwell
