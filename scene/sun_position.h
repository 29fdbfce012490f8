#pragma once

namespace lightwell {

/// A date of the Gregorian calendar and a time of day, in the time of a zone `hours_east` of
/// Greenwich (UTC + hours_east; summer time is one more).
struct ClockTime {
  int year = 2000, month = 1, day = 1;
  double hour = 12.0;  ///< [0, 24)
  double hours_east = 0.0;
};

/// Where the sun stands: azimuth clockwise from north, altitude of its middle above the horizon.
struct SunPosition {
  double azimuth_degrees = 0.0;   ///< [0, 360)
  double altitude_degrees = 0.0;  ///< [-90, 90]
};

/// After the low-precision formulas of the Astronomical Almanac as Michalsky 1988 gives them ("The
/// Astronomical Almanac's algorithm for approximate solar position (1950-2050)", Solar Energy 40):
/// to 0.01 degrees from 1950 to 2050. As geometry has it, without the refraction that lifts a sun
/// on the horizon by half a degree. `latitude` is north, `longitude` east, in degrees. Throws
/// std::invalid_argument for a date that is none, or outside 1900 to 2100, where 0.1 degrees hold.
SunPosition sun_position(const ClockTime& when, double latitude, double longitude);

/// 1 for the first of January.
int day_of_year(int year, int month, int day);

}  // namespace lightwell
