#include "scene/sun_position.h"

#include <fmt/format.h>

#include <chrono>
#include <cmath>
#include <stdexcept>

#include "scene/degree.h"

namespace lightwell {
namespace {

std::chrono::sys_days checked_day(int year, int month, int day) {
  const std::chrono::year_month_day date{std::chrono::year(year),
                                         std::chrono::month(static_cast<unsigned>(month)),
                                         std::chrono::day(static_cast<unsigned>(day))};
  if (month < 1 || day < 1 || !date.ok() || year < 1900 || year > 2100) {
    throw std::invalid_argument(
        fmt::format("{:04}-{:02}-{:02} is no date from 1900 to 2100", year, month, day));
  }
  return date;
}

double wrapped_degrees(double degrees) {
  const double rest = std::fmod(degrees, 360.0);
  return rest < 0.0 ? rest + 360.0 : rest;
}

}  // namespace

int day_of_year(int year, int month, int day) {
  return static_cast<int>((checked_day(year, month, day) - checked_day(year, 1, 1)).count()) + 1;
}

SunPosition sun_position(const ClockTime& when, double latitude, double longitude) {
  if (!(when.hour >= 0.0 && when.hour < 24.0) || !(std::abs(when.hours_east) <= 14.0)) {
    throw std::invalid_argument(
        fmt::format("{} h in the time zone {:+} is no time of day; give [0, 24) and -14 to 14",
                    when.hour, when.hours_east));
  }
  if (!(std::abs(latitude) <= 90.0) || !(std::abs(longitude) <= 360.0)) {
    throw std::invalid_argument(fmt::format(
        "latitude {} and longitude {} are no place; give -90 to 90 and -180 to 180 degrees",
        latitude, longitude));
  }
  const auto date = checked_day(when.year, when.month, when.day);
  const std::chrono::sys_days epoch =
      std::chrono::year(2000) / std::chrono::January / std::chrono::day(1);
  const double universal_hour = when.hour - when.hours_east;
  // Days since noon of 2000-01-01.
  const double n = static_cast<double>((date - epoch).count()) - 0.5 + universal_hour / 24.0;
  const double mean_longitude = 280.460 + 0.9856474 * n;
  const double anomaly = (357.528 + 0.9856003 * n) * degree;
  const double ecliptic =
      (mean_longitude + 1.915 * std::sin(anomaly) + 0.020 * std::sin(2.0 * anomaly)) * degree;
  const double obliquity = (23.439 - 4e-7 * n) * degree;
  const double right_ascension =
      std::atan2(std::cos(obliquity) * std::sin(ecliptic), std::cos(ecliptic));
  const double sin_declination = std::sin(obliquity) * std::sin(ecliptic);
  const double cos_declination = std::sqrt(1.0 - sin_declination * sin_declination);
  // Sidereal time: 24 h and 3.94 minutes a day, n counting from noon.
  const double sidereal = 280.46061837 + 360.98564737 * n + longitude;
  const double hour_angle = sidereal * degree - right_ascension;
  const double sin_latitude = std::sin(latitude * degree),
               cos_latitude = std::cos(latitude * degree);
  const double up =
      sin_declination * sin_latitude + cos_declination * cos_latitude * std::cos(hour_angle);
  const double north =
      sin_declination * cos_latitude - cos_declination * sin_latitude * std::cos(hour_angle);
  const double east = -cos_declination * std::sin(hour_angle);
  return {.azimuth_degrees = wrapped_degrees(std::atan2(east, north) / degree),
          .altitude_degrees = std::atan2(up, std::hypot(north, east)) / degree};
}

double relative_air_mass(double altitude_degrees) {
  return 1.0 / (std::sin(altitude_degrees * degree) +
                0.50572 * std::pow(altitude_degrees + 6.07995, -1.6364));
}

}  // namespace lightwell
