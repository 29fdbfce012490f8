#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "scene/bands.h"
#include "scene/sky.h"
#include "scene/sky_patches.h"

namespace lightwell {

struct ClockTime;
struct Weather;

/// Sun and sky of one hour, even over the hour.
struct SkyHour {
  int number = 0;                                  ///< of the year, from 0; 24 a day
  Eigen::Vector3d sun = Eigen::Vector3d::UnitZ();  ///< unit, to the middle of the sun
  double altitude_degrees = 0.0, azimuth_degrees = 0.0;
  double sun_lux = 0.0;   ///< across the sun's rays
  double dome_lux = 0.0;  ///< on open level ground, from the dome
  SkyGradation gradation{};

  /// Illuminance of open level ground by sun and dome, lx.
  double horizontal_lux(const Eigen::Vector3d& up) const;
};

/// The hours of a year in which there is light, in order.
///
/// - The sun stands where it is in the middle of the hour. Hours with the middle of the sun below
///   the horizon then, or without light of the dome, are dark.
/// - Positions are those of the dates of 2017, or of the leap year 2016.
/// - The dome is Perez' all-weather sky of the hour's irradiances, its state within the model's
///   data.
/// - Lux follow from watts by the efficacies of the same model, with the water in the air by the
///   hour's dew point.
std::vector<SkyHour> sky_hours(const Weather& weather, const Eigen::Vector3d& up,
                               const Eigen::Vector3d& north);

/// Sun and sky of an instant, in the weather's standard time: the irradiances are the means of the
/// hour that holds the instant, and the sun stands where it is at the instant, in the year of
/// `when`. `when.hours_east` is not looked at. Empty: the middle of the sun is below the horizon,
/// or the dome has no light. Throws InputError for a date that the weather's year does not have.
std::optional<SkyHour> sky_instant(const Weather& weather, const ClockTime& when,
                                   const Eigen::Vector3d& up, const Eigen::Vector3d& north);

/// Throws InputError if `hours` of the weather are none: there is no light to compute with.
void require_light(const Weather& weather, const std::vector<SkyHour>& hours);

/// A sentence on hours that have light in the file and are dark in `hours`; empty: there are none.
std::string note_on_dark_hours(const Weather& weather, const std::vector<SkyHour>& hours);

/// Mean luminance of each column, cd/m^2: the dome's patches, scaled so that they light open level
/// ground with the hour's dome_lux, and the ground, which sun and dome light.
Eigen::ArrayXf column_luminances(const SkyPatches& sky, const SkyHour& hour,
                                 double ground_reflectance);

/// column_luminances() of each of `hours`: columns x hours.
BandArray hour_luminances(const SkyPatches& sky, std::span<const SkyHour> hours,
                          double ground_reflectance);

/// column_luminances() of CIE's standard overcast sky (Moon & Spencer 1942) of 1 lx on open level
/// ground.
Eigen::ArrayXf overcast_luminances(const SkyPatches& sky, double ground_reflectance);

}  // namespace lightwell
