#pragma once

#include "scene/sky.h"

namespace lightwell {

/// Gradation of the all-weather sky of a state (Perez, Seals & Michalsky 1993), for the sun
/// above the horizon.
SkyGradation perez_sky(const SkyState& state, double sun_altitude_degrees);

/// The nearest state within the range of the data that Perez' formulas were fitted to, as
/// RADIANCE's gendaymtx has the range: clearness from 1 to 11.9, brightness from 0.01 to 0.6.
SkyState within_data(SkyState state);

/// Luminous efficacy of daylight, lm/W over its whole spectrum, >= 0.
struct DaylightEfficacy {
  double diffuse = 0.0;  ///< of the dome
  double direct = 0.0;   ///< of the sun
};

/// Efficacy under a sky of this state, for the sun above the horizon and `water_cm` of water in
/// the air (Perez, Ineichen, Seals, Michalsky & Stewart 1990, table 4).
DaylightEfficacy daylight_efficacy(const SkyState& state, double sun_altitude_degrees,
                                   double water_cm);

/// Depth that all vapour above a place would fill as water, cm, by the dew point at the ground
/// (Wright, Perez & Michalsky 1989, "Luminous efficacy of direct irradiance").
double precipitable_water_cm(double dew_point_celsius);

}  // namespace lightwell
