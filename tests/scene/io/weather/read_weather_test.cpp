#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "scene/errors.h"
#include "scene/io/weather/weather_file.h"
#include "tests/scene/expected_messages.h"
#include "tests/temporary_folder.h"

namespace lightwell::read_weather_test {
namespace {

// Light that tells every hour apart.
double direct_of(int number) {
  return number % 997;
}
double diffuse_of(int number) {
  return number % 101;
}

const std::string epw_heading =
    "LOCATION,Testville,ST,Land,SRC,123456,37.72,-122.22,-8.0,2.0\n"
    "DESIGN CONDITIONS,0\n"
    "DATA PERIODS,1,1,Data,Sunday, 1/ 1,12/31\n";

std::string epw_row(int number, const std::string& direct, const std::string& dew_point = "7.0") {
  const auto [month, day, hour] = hour_of_year(number, false);
  return fmt::format("1999,{},{},{},0,?9,9.0,{},87,102000,0,0,305,0,{},{},0,0\n", month, day,
                     hour + 1, dew_point, direct, diffuse_of(number));
}

std::string epw_text(int hours = 8760) {
  std::string text = epw_heading;
  for (int n = 0; n < hours; ++n) text += epw_row(n, fmt::format("{}", direct_of(n)));
  return text;
}

const std::string wea_heading =
    "place Testville, Land\n"
    "latitude 37.72\n"
    "longitude 122.22\n"
    "time_zone 120\n"
    "site_elevation 2.0\n"
    "weather_data_file_units 1\n";

std::string wea_text() {
  std::string text = wea_heading;
  for (int n = 0; n < 8760; ++n) {
    const auto [month, day, hour] = hour_of_year(n, false);
    text += fmt::format("{} {} {} {} {}\n", month, day, hour + 0.5, direct_of(n), diffuse_of(n));
  }
  return text;
}

std::string message_of(const std::string& name, const std::string& text) {
  const TemporaryFolder folder;
  try {
    read_weather(folder.write(name, text));
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

}  // namespace

TEST(ReadWeather, BothFormatsGiveTheSameHours) {
  const TemporaryFolder folder;
  const Weather epw = read_weather(folder.write("a.epw", epw_text())),
                wea = read_weather(folder.write("a.WEA", wea_text()));
  for (const Weather* weather : {&epw, &wea}) {
    EXPECT_NEAR(weather->latitude, 37.72, 1e-12);
    EXPECT_NEAR(weather->longitude, -122.22, 1e-12);
    EXPECT_NEAR(weather->hours_east, -8.0, 1e-12);
    EXPECT_EQ(weather->place, "Testville, Land");
    EXPECT_FALSE(weather->is_leap_year);
    ASSERT_EQ(weather->hours.size(), 8760u);
    EXPECT_TRUE(weather->notes.empty());
    for (int n = 0; n < 8760; ++n) {
      const WeatherHour& hour = weather->hours[static_cast<std::size_t>(n)];
      ASSERT_EQ(hour.direct_normal, direct_of(n)) << weather->format << " hour " << n;
      ASSERT_EQ(hour.diffuse_horizontal, diffuse_of(n)) << weather->format << " hour " << n;
    }
  }
  EXPECT_EQ(epw.hours[100].dew_point, 7.0);
  EXPECT_EQ(wea.hours[100].dew_point, usual_dew_point);
}

TEST(ReadWeather, HoursOfTheYearAreNumberedFromNewYear) {
  for (const bool is_leap_year : {false, true}) {
    for (int n = 0; n < (is_leap_year ? 8784 : 8760); ++n) {
      ASSERT_EQ(number_of(hour_of_year(n, is_leap_year), is_leap_year), n);
    }
  }
  EXPECT_EQ(number_of({.month = 3, .day = 1}, false), 24 * 59);
  EXPECT_EQ(number_of({.month = 3, .day = 1}, true), 24 * 60);
  EXPECT_EQ(number_of({.month = 2, .day = 29}, false), -1);
}

TEST(ReadWeather, MissingValuesAreDarkAndSaidOnce) {
  std::string text = epw_heading;
  for (int n = 0; n < 8760; ++n) {
    text += epw_row(n, n % 1000 == 0 ? "9999" : "100", n == 5 ? "99.9" : "7.0");
  }
  const TemporaryFolder folder;
  const Weather weather = read_weather(folder.write("a.epw", text));
  EXPECT_EQ(weather.hours[1000].direct_normal, 0.0);
  EXPECT_EQ(weather.hours[1001].direct_normal, 100.0);
  EXPECT_EQ(weather.hours[5].dew_point, usual_dew_point);
  ASSERT_EQ(weather.notes.size(), 2u);
  EXPECT_NE(weather.notes[0].find("9 irradiances are missing"), std::string::npos)
      << weather.notes[0];
}

// 21 June, 12:30 in the zone of UTC - 8, at 37.72 degrees north and 122.22 west, is 12:19.6 by the
// sun: 8.9 min earlier by the longitude, and 1.5 by the equation of time. The declination is 23.44
// degrees. The last digits of these are 0.03 degrees at most, of which the sine of the altitude, 75
// degrees, changes by 0.03 pi / 180 cos 75 = 1.4e-4.
TEST(ReadWeather, GlobalLightTellsDirectOrDiffuseLight) {
  const int noon = number_of({6, 21, 12}, false), night = number_of({6, 21, 0}, false);
  const auto hours_of = [&](const std::string& global, const std::string& direct,
                            const std::string& diffuse) {
    std::string text = epw_heading;
    for (int n = 0; n < 8760; ++n) {
      const auto [month, day, hour] = hour_of_year(n, false);
      text += fmt::format("1999,{},{},{},0,?9,9.0,7.0,87,102000,0,0,305,{},{},{},0,0\n", month, day,
                          hour + 1, n == noon || n == night ? global : "0",
                          n == noon || n == night ? direct : "0",
                          n == noon || n == night ? diffuse : "0");
    }
    const TemporaryFolder folder;
    return read_weather(folder.write("a.epw", text));
  };
  const auto radians = [](double degrees) { return degrees * std::numbers::pi / 180.0; };
  const double latitude = radians(37.72), declination = radians(23.44),
               hour_angle = radians(15.0 * 19.6 / 60.0);
  const double sine = std::sin(latitude) * std::sin(declination) +
                      std::cos(latitude) * std::cos(declination) * std::cos(hour_angle);
  constexpr double of_sine = 1.4e-4;
  const Weather without_direct = hours_of("800", "9999", "100");
  EXPECT_NEAR(without_direct.hours[static_cast<std::size_t>(noon)].direct_normal, 700.0 / sine,
              700.0 / sine * of_sine / sine);
  EXPECT_EQ(without_direct.hours[static_cast<std::size_t>(night)].direct_normal, 0.0);
  ASSERT_EQ(without_direct.notes.size(), 2u);
  EXPECT_NE(without_direct.notes[0].find("1 irradiances, direct or diffuse"), std::string::npos);
  EXPECT_NE(without_direct.notes[1].find("1 irradiances are missing"), std::string::npos);
  const Weather without_diffuse = hours_of("800", "600", "");
  EXPECT_NEAR(without_diffuse.hours[static_cast<std::size_t>(noon)].diffuse_horizontal,
              800.0 - 600.0 * sine, 600.0 * of_sine);
  EXPECT_EQ(hours_of("50", "9999", "100").hours[static_cast<std::size_t>(noon)].direct_normal, 0.0)
      << "less than the diffuse light";
}

TEST(ReadWeather, HoursThatAWeaFileLeavesOutAreDark) {
  const TemporaryFolder folder;
  const Weather weather =
      read_weather(folder.write("a.wea", wea_heading + "6 21 12.5 800 100\n12 21 12.500 300 50\n"));
  EXPECT_EQ(weather.hours[static_cast<std::size_t>(number_of({6, 21, 12}, false))].direct_normal,
            800.0);
  EXPECT_EQ(weather.hours[0].diffuse_horizontal, 0.0);
  ASSERT_EQ(weather.notes.size(), 1u);
  EXPECT_NE(weather.notes[0].find("2 of 8760 hours"), std::string::npos) << weather.notes[0];
}

TEST(ReadWeather, WrongFilesAreRefusedWithTheirLine) {
  const std::string cut = epw_text(100);
  for (const auto& [name, text, expected] : std::vector<std::array<std::string, 3>>{
           {"a.csv", epw_text(1), "weather is read from .epw"},
           {"a.epw", cut, ":103: the file has 100 hours where a year has 8760"},
           {"a.epw", cut.substr(0, cut.size() - 60), "cut short"},
           {"a.epw", "", "no LOCATION line"},
           {"a.epw", epw_row(0, "1"), ":1: comes before the LOCATION"},
           {"a.epw", epw_heading + epw_row(0, "-5"), "':4:"},
           {"a.epw", epw_heading + epw_row(0, "bright"), "'bright'"},
           {"a.epw", epw_heading + epw_row(0, "1") + epw_row(0, "1"), "second row"},
           {"a.epw", "LOCATION,a,b,c,d,e,137.0,0,0\n", "latitude is 137"},
           {"a.epw", "LOCATION,a,b\n", "too few fields"},
           {"a.wea", wea_heading, "has no hours"},
           {"a.wea", "6 21 12.5 1 1\n", ":1: comes before latitude"},
           {"a.wea", wea_heading + "2 30 12.5 1 1\n", "is no hour of the year"},
           {"a.wea", wea_heading + "6 21 12.5\n", "has 3 numbers"},
           {"a.wea", "weather_data_file_units 2\n", "the units are 2"},
           {"a.wea", "altitude 3\n", "'altitude' is no word"}}) {
    const std::string message = message_of(name, text);
    if (expected == "':4:") {
      EXPECT_NE(message.find(":4: the direct normal irradiance is '-5'"), std::string::npos)
          << message;
      continue;
    }
    EXPECT_NE(message.find(expected), std::string::npos) << name << ": " << message;
  }
}

}  // namespace lightwell::read_weather_test
