#pragma once

#include <vector>

#include "scene/io/weather/weather_file.h"

namespace lightwell {

/// The year whose dates the hours of a typical year have, which is put together from months of
/// several years: 2017, or the leap year 2016.
int year_of_dates(bool is_leap_year);

/// An hour of a year in which the sun stands above the horizon, and its light.
struct SunHour {
  int number = 0;  ///< of the year, from 0; 24 a day
  double altitude_degrees = 0.0, azimuth_degrees = 0.0;
  double direct_normal = 0.0, diffuse_horizontal = 0.0;  ///< W/m^2, see WeatherHour
};

/// The hours of a year with light, in order. The sun stands where it is in the middle of the hour
/// on the dates of year_of_dates(), without refraction; hours with its middle below the horizon
/// then are dark.
std::vector<SunHour> sun_hours(const Weather& weather);

}  // namespace lightwell
