// RADIANCE's weather for gendaymtx: a heading of six words with their values, then rows of month,
// day, hour, and two values of light.
#include <fmt/format.h>

#include <cmath>

#include "scene/io/weather/weather_rows.h"

namespace lightwell {
namespace {

constexpr double degrees_per_hour = 15.0;

// The heading's values so far, and the number of those that a place needs.
struct Heading {
  int found = 0;
  bool has_units = false;
};

// Reads a line of the heading. Longitude and time zone are degrees west.
void read_heading(const TextFile& file, int line, std::string_view text, Weather& weather,
                  Heading& heading) {
  std::string_view rest = text;
  const std::string_view word = next_word(rest);
  if (word == "place") {
    weather.place = trimmed(rest);
    return;
  }
  const auto value = parse_finite(trimmed(rest));
  if (!value) file.fail(line, fmt::format("'{}' has no number behind it", excerpt(word)));
  if (word == "site_elevation") return;
  if (word == "weather_data_file_units") {
    if (*value != 1.0) {
      file.fail(line,
                fmt::format("the units are {:g}; only 1, direct normal and diffuse horizontal "
                            "irradiance in W/m2, is read",
                            *value));
    }
    heading.has_units = true;
    return;
  }
  if (word == "latitude") {
    weather.latitude = *value;
  } else if (word == "longitude") {
    weather.longitude = -*value;
  } else if (word == "time_zone") {
    weather.hours_east = -*value / degrees_per_hour;
  } else {
    file.fail(line, fmt::format("'{}' is no word of the heading, which has place, latitude, "
                                "longitude, time_zone, site_elevation and weather_data_file_units",
                                excerpt(word)));
  }
  ++heading.found;
}

std::vector<std::string_view> words_of(std::string_view text) {
  std::vector<std::string_view> words;
  for (auto word = next_word(text); !word.empty(); word = next_word(text)) words.push_back(word);
  return words;
}

}  // namespace

Weather read_wea(const std::filesystem::path& path) {
  const TextFile file(path);
  Weather weather{.file = path, .format = "RADIANCE (WEA)"};
  constexpr int needed = 3;  // latitude, longitude and time zone
  Heading heading;
  file.for_each_line([&](int, std::string_view text) {
    const auto words = words_of(text);
    weather.is_leap_year |=
        words.size() >= 2 && parse_finite(words[0]) == 2.0 && parse_finite(words[1]) == 29.0;
  });
  WeatherRows rows(file, weather);
  file.for_each_line([&](int line, std::string_view text) {
    const auto words = words_of(text);
    if (words.empty() || words.front().starts_with('#')) return;
    if (!parse_finite(words.front())) {
      read_heading(file, line, text, weather, heading);
      return;
    }
    if (heading.found < needed || !heading.has_units) {
      file.fail(line, "comes before latitude, longitude, time_zone and weather_data_file_units");
    }
    if (words.size() < 5) {
      file.fail(line, fmt::format("has {} numbers; a row has month, day, hour, and direct and "
                                  "diffuse irradiance",
                                  words.size()));
    }
    const auto month = parse_finite(words[0]), day = parse_finite(words[1]),
               hour = parse_finite(words[2]);
    if (!month || !day || !hour || *month != std::floor(*month) || *day != std::floor(*day) ||
        std::abs(*month) > 12 || std::abs(*day) > 31 || std::abs(*hour) > 24) {
      file.fail(line, "has no month, day and hour; the middle of the first hour is '1 1 0.5'");
    }
    rows.set(line,
             {.month = static_cast<int>(*month),
              .day = static_cast<int>(*day),
              .hour = static_cast<int>(std::floor(*hour))},
             {.direct_normal = words[3], .diffuse_horizontal = words[4]});
  });
  if (heading.found < needed) file.fail(1, "has no latitude, longitude and time_zone");
  check_place(file, 1, weather);
  if (rows.count() == 0) file.fail(1, "has no hours");
  rows.note_missing();
  if (rows.count() < static_cast<int>(weather.hours.size())) {
    weather.notes.push_back(fmt::format("{}: {} of {} hours are given; the others are dark",
                                        path.filename().string(), rows.count(),
                                        weather.hours.size()));
  }
  return weather;
}

}  // namespace lightwell
