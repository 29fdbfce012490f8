#include "scene/io/weather/sun_hours.h"

#include <gtest/gtest.h>

#include "scene/sun_position.h"

namespace lightwell::sun_hours_test {
namespace {

// A place at 48 degrees north and 15 degrees east, whose standard time is that of its meridian.
Weather year_of(bool is_leap_year) {
  Weather weather{
      .latitude = 48.0, .longitude = 15.0, .hours_east = 1.0, .is_leap_year = is_leap_year};
  weather.hours.resize(is_leap_year ? 8784 : 8760);
  return weather;
}

}  // namespace

TEST(SunHours, AreThoseWithLightAndTheSunAboveTheHorizonInTheirMiddle) {
  for (const bool is_leap_year : {false, true}) {
    Weather weather = year_of(is_leap_year);
    const int midnight = number_of({.month = 3, .day = 1}, is_leap_year);
    for (const int hour : {0, 9, 15}) {
      WeatherHour& light = weather.hours[static_cast<std::size_t>(midnight + hour)];
      light.direct_normal = 10.0 * hour;
      light.diffuse_horizontal = 5.0;
    }
    weather.hours[static_cast<std::size_t>(midnight + 12)].direct_normal = 1.0;
    const std::vector<SunHour> hours = sun_hours(weather);
    ASSERT_EQ(hours.size(), 3u);  // without that of midnight
    EXPECT_EQ(hours[0].number, midnight + 9);
    EXPECT_EQ(hours[1].number, midnight + 12);
    EXPECT_EQ(hours[2].number, midnight + 15);
    EXPECT_EQ(hours[0].direct_normal, 90.0);
    EXPECT_EQ(hours[0].diffuse_horizontal, 5.0);
    EXPECT_EQ(hours[1].diffuse_horizontal, 0.0);
    const SunPosition sun = sun_position(
        {.year = year_of_dates(is_leap_year), .month = 3, .day = 1, .hour = 9.5, .hours_east = 1.0},
        48.0, 15.0);
    EXPECT_EQ(hours[0].altitude_degrees, sun.altitude_degrees);
    EXPECT_EQ(hours[0].azimuth_degrees, sun.azimuth_degrees);
  }
}

TEST(SunHours, OfADarkYearAreNone) {
  EXPECT_TRUE(sun_hours(year_of(false)).empty());
}

}  // namespace lightwell::sun_hours_test
