#pragma once

#include "scene/io/weather/weather_file.h"

namespace lightwell::test {

/// Weather of Oakland with light on three days, the longest, the shortest and one in March, from 7
/// to 17 h standard time: a clear morning and a cloudy afternoon.
inline Weather three_days() {
  Weather weather{
      .place = "Testville", .latitude = 37.72, .longitude = -122.22, .hours_east = -8.0};
  weather.hours.resize(8760);
  for (const auto& [month, day] : {std::pair(3, 21), std::pair(6, 21), std::pair(12, 21)}) {
    const int midnight = number_of({.month = month, .day = day, .hour = 0}, false);
    for (int hour = 7; hour < 17; ++hour) {
      WeatherHour& light = weather.hours[static_cast<std::size_t>(midnight + hour)];
      light.direct_normal = hour < 13 ? 100.0 * (hour - 5) : 40.0;
      light.diffuse_horizontal = 60.0 + 10.0 * (hour % 7);
    }
  }
  return weather;
}

}  // namespace lightwell::test
