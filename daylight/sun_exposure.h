#pragma once

#include <Eigen/Core>
#include <span>
#include <string>
#include <vector>

#include "daylight/daylight_model.h"
#include "scene/io/weather/weather_file.h"

namespace lightwell {

/// A day without clouds for exposure to sunlight, EN 17037:2018: one from 1 February to 21 March.
struct ExposureDay {
  int month = 3, day = 21;
  double least_altitude_degrees = 0.0;  ///< of the sun that counts, [0, 90)
};

/// Reads "03-21", month and day. Throws InputError for other text, and for another day than those
/// of the standard.
ExposureDay read_exposure_day(const std::string& text);

/// Hours of the day in which each point (m) has the middle of the sun in sight, straight or through
/// clear panes: the minutes in whose middle it has. The year is 2017.
Eigen::ArrayXd sun_exposure(const DaylightModel& model, const Weather& weather,
                            std::span<const Eigen::Vector3d> points, const ExposureDay& day);

/// EN 17037:2018, table A.6: "minimum" from 1.5 h, "medium" from 3 h, "high" from 4 h; else "none".
std::string exposure_level(double hours);

}  // namespace lightwell
