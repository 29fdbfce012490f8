#pragma once

namespace lightwell {

/// A date of the Gregorian calendar and a time of day, in the time zone UTC + `hours_east` (summer
/// time is one hour more).
struct ClockTime {
  int year = 2000, month = 1, day = 1;
  double hour = 12.0;  ///< [0, 24)
  double hours_east = 0.0;
};

/// Azimuth of the sun, clockwise from north, and altitude of its middle above the horizon.
struct SunPosition {
  double azimuth_degrees = 0.0;   ///< [0, 360)
  double altitude_degrees = 0.0;  ///< [-90, 90]
};

/// Position of the sun by the low-precision formulas of the Astronomical Almanac, after Michalsky
/// 1988 ("The Astronomical Almanac's algorithm for approximate solar position (1950-2050)", Solar
/// Energy 40). Error: 0.01 degrees from 1950 to 2050, 0.1 degrees from 1900 to 2100. Refraction,
/// which lifts a sun on the horizon by half a degree, is not included. `latitude` is north,
/// `longitude` east, in degrees.
///
/// Throws std::invalid_argument for a date that does not exist or lies outside 1900 to 2100, and
/// for a time of day, a time zone or a place out of range.
SunPosition sun_position(const ClockTime& when, double latitude, double longitude);

/// Air that the sun's rays pass, relative to the path from the zenith; altitude in degrees, (0, 90]
/// (Kasten & Young 1989, "Revised optical air mass tables and approximation formula").
double relative_air_mass(double altitude_degrees);

/// Number of the day within its year, 1 for the first of January. Throws like sun_position().
int day_of_year(int year, int month, int day);

}  // namespace lightwell
