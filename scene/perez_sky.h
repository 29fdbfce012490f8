#pragma once

#include "scene/sky.h"

namespace lightwell {

/// State of a sky by its light (Perez, Ineichen, Seals, Michalsky & Stewart 1990).
struct SkyState {
  double clearness = 1.0;   ///< epsilon, >= 1; 1: overcast
  double brightness = 0.0;  ///< Delta, > 0
};

/// State of a sky; arguments as for perez_sky(), which checks them.
SkyState sky_state(double direct_normal, double diffuse_horizontal, double sun_altitude_degrees,
                   int day_of_year);

/// Direct normal irradiance, W/m^2, of a sky of this clearness: the inverse of sky_state().
double direct_normal_of(double clearness, double diffuse_horizontal, double sun_altitude_degrees);

/// Irradiance of a plane across the sun's rays outside the atmosphere, W/m^2 (Spencer 1971, first
/// order).
double extraterrestrial_irradiance(int day_of_year);

/// Gradation of the all-weather sky (Perez, Seals & Michalsky 1993). `direct_normal` and
/// `diffuse_horizontal` are irradiances, W/m^2; `day_of_year` counts from 1. Throws
/// std::invalid_argument if the diffuse irradiance is not above 0, the direct one is below 0 or the
/// sun is not above the horizon.
SkyGradation perez_sky(double direct_normal, double diffuse_horizontal, double sun_altitude_degrees,
                       int day_of_year);

/// The same for a state that is known, for the sun above the horizon.
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
DaylightEfficacy perez_efficacy(const SkyState& state, double sun_altitude_degrees,
                                double water_cm);

/// Depth that all vapour above a place would fill as water, cm, by the dew point at the ground
/// (Wright, Perez & Michalsky 1989, "Luminous efficacy of direct irradiance").
double precipitable_water_cm(double dew_point_celsius);

}  // namespace lightwell
