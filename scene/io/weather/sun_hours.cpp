#include "scene/io/weather/sun_hours.h"

#include "scene/sun_position.h"

namespace lightwell {

int year_of_dates(bool is_leap_year) {
  return is_leap_year ? 2016 : 2017;
}

std::vector<SunHour> sun_hours(const Weather& weather) {
  std::vector<SunHour> hours;
  for (int n = 0; n < static_cast<int>(weather.hours.size()); ++n) {
    const WeatherHour& light = weather.hours[static_cast<std::size_t>(n)];
    if (!(light.direct_normal + light.diffuse_horizontal > 0.0)) continue;
    const auto [month, day, hour] = hour_of_year(n, weather.is_leap_year);
    const SunPosition sun = sun_position({.year = year_of_dates(weather.is_leap_year),
                                          .month = month,
                                          .day = day,
                                          .hour = hour + 0.5,
                                          .hours_east = weather.hours_east},
                                         weather.latitude, weather.longitude);
    if (!(sun.altitude_degrees > 0.0)) continue;
    hours.push_back({.number = n,
                     .altitude_degrees = sun.altitude_degrees,
                     .azimuth_degrees = sun.azimuth_degrees,
                     .direct_normal = light.direct_normal,
                     .diffuse_horizontal = light.diffuse_horizontal});
  }
  return hours;
}

}  // namespace lightwell
