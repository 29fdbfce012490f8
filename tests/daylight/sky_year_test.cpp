#include "daylight/sky_year.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <numbers>

#include "scene/errors.h"
#include "scene/io/weather/weather_file.h"
#include "scene/sun_position.h"

namespace lightwell::sky_year_test {
namespace {

using Eigen::Vector3d;
using std::numbers::pi;

// Oakland with the same light in every hour.
Weather steady_weather(double direct, double diffuse) {
  Weather weather{.latitude = 37.72, .longitude = -122.22, .hours_east = -8.0};
  weather.hours.assign(8760, {.direct_normal = direct, .diffuse_horizontal = diffuse});
  return weather;
}

std::vector<SkyHour> hours_of(const Weather& weather) {
  return sky_hours(weather, Vector3d::UnitZ(), Vector3d::UnitY());
}

SkyPatches patches() {
  return SkyPatches(2, Vector3d::UnitZ(), Vector3d::UnitY());
}

}  // namespace

TEST(SkyYear, TheSunStandsWhereItIsInTheMiddleOfTheHour) {
  const std::vector<SkyHour> hours = hours_of(steady_weather(500.0, 100.0));
  for (const SkyHour& hour : hours) {
    const auto [month, day, of_day] = hour_of_year(hour.number, false);
    const SunPosition sun = sun_position(
        {.year = 2017, .month = month, .day = day, .hour = of_day + 0.5, .hours_east = -8.0}, 37.72,
        -122.22);
    ASSERT_EQ(hour.altitude_degrees, sun.altitude_degrees);
    ASSERT_GT(hour.altitude_degrees, 0.0);
    ASSERT_NEAR(hour.sun.z(), std::sin(sun.altitude_degrees * pi / 180.0), 1e-12);
  }
  // The sun is up for half of the year.
  EXPECT_NEAR(static_cast<double>(hours.size()), 4380.0, 40.0);
}

// In the middle of an hour of 2017 an instant is that hour of the year; later the sun has moved on,
// and the irradiances are the same.
TEST(SkyYear, AnInstantIsOfItsHour) {
  Weather weather = steady_weather(500.0, 100.0);
  const std::vector<SkyHour> hours = hours_of(weather);
  const auto at = [&](double hour) {
    return sky_instant(weather, {.year = 2017, .month = 6, .day = 21, .hour = hour},
                       Vector3d::UnitZ(), Vector3d::UnitY());
  };
  const auto middle = at(12.5), later = at(12.9);
  ASSERT_TRUE(middle && later);
  const auto same = std::ranges::find(hours, middle->number, &SkyHour::number);
  ASSERT_NE(same, hours.end());
  EXPECT_EQ(middle->sun, same->sun);
  EXPECT_EQ(middle->sun_lux, same->sun_lux);
  EXPECT_EQ(middle->dome_lux, same->dome_lux);
  EXPECT_EQ(later->number, middle->number);
  EXPECT_NE(later->sun, middle->sun);
  EXPECT_FALSE(at(0.5));
  EXPECT_THROW(sky_instant(weather, {.year = 2016, .month = 2, .day = 29}, Vector3d::UnitZ(),
                           Vector3d::UnitY()),
               InputError);
}

TEST(SkyYear, HoursWithoutLightOfTheDomeAreDark) {
  Weather weather = steady_weather(500.0, 0.0);
  weather.hours[12].diffuse_horizontal = 100.0;
  const std::vector<SkyHour> hours = hours_of(weather);
  ASSERT_EQ(hours.size(), 1u);
  EXPECT_EQ(hours[0].number, 12);
}

TEST(SkyYear, AYearWithoutLightIsRefused) {
  Weather weather = steady_weather(500.0, 0.0);
  EXPECT_THROW(require_light(weather, hours_of(weather)), InputError);
  weather.hours[12].diffuse_horizontal = 100.0;
  EXPECT_NO_THROW(require_light(weather, hours_of(weather)));
}

// Light where the sun is up, moved by the six hours of a wrong time zone: a quarter of a day's
// hours, and not of twilight alone.
TEST(SkyYear, LightAtNightPointsToTheTimeZone) {
  Weather weather = steady_weather(0.0, 0.0);
  for (const SkyHour& hour : hours_of(steady_weather(500.0, 100.0))) {
    weather.hours[static_cast<std::size_t>(hour.number)] = {.direct_normal = 500.0,
                                                            .diffuse_horizontal = 100.0};
  }
  EXPECT_EQ(note_on_dark_hours(weather, hours_of(weather)), "");
  weather.hours_east += 6.0;
  const std::string note = note_on_dark_hours(weather, hours_of(weather));
  EXPECT_NE(note.find("check the file's latitude, longitude and time zone"), std::string::npos)
      << note;
  // Twilight of one hour in a year of 4380 is no sign of a wrong place.
  weather.hours_east -= 6.0;
  weather.hours[0] = {.diffuse_horizontal = 100.0};
  const std::string twilight = note_on_dark_hours(weather, hours_of(weather));
  EXPECT_EQ(twilight.rfind("1 hours", 0), 0u) << twilight;
  EXPECT_EQ(twilight.find("time zone"), std::string::npos) << twilight;
}

// Patches are scaled to the hour's light, so the sum is exact to the rounding of 577 floats.
TEST(SkyYear, PatchesLightOpenGroundAsTheDomeDoes) {
  const SkyPatches sky = patches();
  const Eigen::ArrayXd level = sky.irradiances(sky.up()).head(sky.dome_count());
  for (const double direct : {0.0, 300.0, 900.0}) {
    const std::vector<SkyHour> hours = hours_of(steady_weather(direct, 100.0));
    for (std::size_t h = 0; h < hours.size(); h += 97) {
      const Eigen::ArrayXf L = column_luminances(sky, hours[h], 0.2);
      ASSERT_TRUE((L >= 0.0f).all());
      const double lux = (L.head(sky.dome_count()).cast<double>() * level).sum();
      EXPECT_NEAR(lux, hours[h].dome_lux, 1e-6 * hours[h].dome_lux);
      EXPECT_NEAR(double{L[sky.ground_column()]}, 0.2 * hours[h].horizontal_lux(sky.up()) / pi,
                  1e-6 * hours[h].horizontal_lux(sky.up()));
    }
  }
}

TEST(SkyYear, OvercastZenithIsThreeTimesAsBrightAsTheHorizon) {
  const SkyPatches sky = patches();
  const Eigen::ArrayXf L = overcast_luminances(sky, 0.2);
  // (1 + 2 sin a) / 3 of the zenith's 9 / (7 pi), mean over the lowest row, 6.2 degrees high.
  const double zenith = 9.0 / (7.0 * pi);
  EXPECT_NEAR(double{L[sky.dome_count() - 1]}, zenith, 2e-3 * zenith);
  EXPECT_NEAR(double{L[0]}, (1.0 + 2.0 * 0.5 * std::sin(90.0 / 14.5 * pi / 180.0)) / 3.0 * zenith,
              2e-3 * zenith);
}

}  // namespace lightwell::sky_year_test
