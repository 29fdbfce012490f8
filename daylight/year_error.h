#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "daylight/year.h"

namespace lightwell {

/// `samples` of the hours, spread evenly over them; all of them, where there are fewer.
std::vector<SkyHour> spread_over(std::span<const SkyHour> hours, int samples = 64);

/// Root mean square of differences over sensors, relative to the sensors' `light`, or to a quarter
/// of its mean where that is more. Without light: 1 where something differs, else 0.
double relative_difference(const Eigen::ArrayXd& difference, const Eigen::ArrayXd& light);

/// Bound of the error of the sensors' light without direct sunlight, with odds of about 19 to 1:
/// for the light of a year, one figure for all sensors of the model. Relative to the sensor's own
/// light, or to a quarter of the mean of all sensors where that is more, since a sensor within
/// furniture may have next to no light.
///
/// A second computation, with a quarter of the patches, half of the rays and other random numbers,
/// differs from the first at each sensor, in the mean over `samples` hours all over the year. Its
/// error is four times as large where patches decide (their error falls with their area), and 1.7
/// times where rays do (noise falls with about the 3/4th power of their number). The root mean
/// square d of the differences over the sensors is thus three times, or sqrt(1.7^2 + 1) = 2 times,
/// the error of the first: two standard errors. Few sensors know d badly, so d is widened by
/// Student's distribution. The subdivision of the sky is not in d.
///
/// Throws Interrupted when the model's progress says stop.
double year_error(const DaylightModel& model, const SkyCoefficients& sky,
                  std::span<const SkyHour> hours, double ground_reflectance, int samples = 64);

}  // namespace lightwell
