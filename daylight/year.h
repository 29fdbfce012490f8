#pragma once

#include <Eigen/Core>
#include <functional>
#include <span>

#include "daylight/daylight_model.h"
#include "daylight/sky_year.h"

namespace lightwell {

/// Illuminance of the sensors of a DaylightModel in several hours, lx: sensors x hours.
struct HourBlock {
  std::span<const SkyHour> hours{};
  Eigen::ArrayXXf total{};
  Eigen::ArrayXXf sunlight{};  ///< the part straight from the sun, through panes

  /// Illuminance of a sensor in an hour, with `factor` on all light but the sun's own. The factor
  /// shows what an error of that light does to measures; direct sunlight is taken as it is.
  float light(Eigen::Index sensor, Eigen::Index hour, float factor) const {
    const float sun = sunlight(sensor, hour);
    return sun + factor * (total(sensor, hour) - sun);
  }
};

/// Coefficients of the sky's columns at the sensors, lx over cd/m^2: sensors x columns, direct and
/// reflected light together.
using SkyCoefficients = Eigen::ArrayXXf;

/// Calls `visit` with blocks of `hours`, in order: the light of each hour's own dome by the
/// coefficients, and of the sun as a disc where it stands in that hour, straight and reflected.
/// Throws Interrupted when the model's progress says stop.
void simulate_year(const DaylightModel& model, const SkyCoefficients& sky,
                   std::span<const SkyHour> hours, double ground_reflectance,
                   const std::function<void(const HourBlock&)>& visit);

/// Daylight factor of each sensor, [0, 1]: its share of the illuminance of open ground under CIE's
/// overcast sky.
Eigen::ArrayXf daylight_factors(const DaylightModel& model, const SkyCoefficients& sky,
                                double ground_reflectance);

}  // namespace lightwell
