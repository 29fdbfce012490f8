// EnergyPlus weather: eight lines of heading, then a row of 35 fields for each hour (EnergyPlus
// Auxiliary Programs, "EnergyPlus Weather File (EPW) Data Dictionary").
#include <fmt/format.h>

#include <cmath>
#include <string>

#include "scene/io/comma_fields.h"
#include "scene/io/weather/weather_rows.h"

namespace lightwell {
namespace {

constexpr std::size_t fields_needed = 16;  // up to the diffuse irradiance
constexpr std::size_t month_field = 1, day_field = 2, hour_field = 3;
constexpr std::size_t dew_point_field = 7, global_field = 13, direct_field = 14, diffuse_field = 15;
constexpr double highest_dew_point = 70.0;  // of the data dictionary; 99.9: missing

double heading_number(const TextFile& file, int line, std::string_view field, const char* name) {
  const auto value = parse_finite(field);
  if (!value) file.fail(line, fmt::format("the {} '{}' is no number", name, excerpt(field)));
  return *value;
}

void read_location(const TextFile& file, int line, std::string_view text, Weather& weather) {
  const auto fields = comma_fields(text);
  constexpr std::size_t latitude = 6, longitude = 7, zone = 8;
  if (fields.size() <= zone) {
    file.fail(line,
              "LOCATION has too few fields; it names city, state, country, source, station, "
              "latitude, longitude and time zone");
  }
  weather.place = fields[1];
  if (!fields[3].empty()) weather.place += fmt::format(", {}", fields[3]);
  weather.latitude = heading_number(file, line, fields[latitude], "latitude");
  weather.longitude = heading_number(file, line, fields[longitude], "longitude");
  weather.hours_east = heading_number(file, line, fields[zone], "time zone");
  check_place(file, line, weather);
}

int whole(const TextFile& file, int line, std::string_view field, const char* name) {
  const auto value = parse_finite(field);
  if (!value || *value < 0.0 || *value > 9999.0 || *value != std::floor(*value)) {
    file.fail(line, fmt::format("the {} '{}' is no whole number", name, excerpt(field)));
  }
  return static_cast<int>(*value);
}

// The rows of hours, whose first field is a year, and their line numbers.
struct Rows {
  std::vector<std::pair<int, std::vector<std::string_view>>> rows{};
  bool has_leap_day = false;
};

Rows rows_of(const TextFile& file, Weather& weather) {
  Rows found;
  bool has_location = false;
  file.for_each_line([&](int line, std::string_view text) {
    if (text.starts_with("LOCATION")) {
      read_location(file, line, text, weather);
      has_location = true;
      return;
    }
    if (text.empty() || text.front() < '0' || text.front() > '9') return;
    if (!has_location)
      file.fail(line, "comes before the LOCATION line that an EPW file begins with");
    auto fields = comma_fields(text);
    if (fields.size() < fields_needed) {
      file.fail(line, fmt::format("has {} fields; a row of an EPW file has 35, and the file may be "
                                  "cut short",
                                  fields.size()));
    }
    found.has_leap_day |=
        parse_finite(fields[month_field]) == 2.0 && parse_finite(fields[day_field]) == 29.0;
    found.rows.emplace_back(line, std::move(fields));
  });
  if (!has_location) file.fail(1, "has no LOCATION line, so it is no EPW file");
  return found;
}

}  // namespace

Weather read_epw(const std::filesystem::path& path) {
  const TextFile file(path);
  Weather weather{.file = path, .format = "EnergyPlus (EPW)"};
  const Rows found = rows_of(file, weather);
  weather.is_leap_year = found.has_leap_day;
  WeatherRows rows(file, weather);
  int without_dew_point = 0;
  for (const auto& [line, fields] : found.rows) {
    const HourOfYear hour{.month = whole(file, line, fields[month_field], "month"),
                          .day = whole(file, line, fields[day_field], "day"),
                          // The label is the end of the hour, 1 to 24.
                          .hour = whole(file, line, fields[hour_field], "hour") - 1};
    rows.set(line, hour,
             {.direct_normal = fields[direct_field],
              .diffuse_horizontal = fields[diffuse_field],
              .global_horizontal = fields[global_field]});
    const auto dew_point = parse_finite(fields[dew_point_field]);
    const bool is_known = dew_point && std::abs(*dew_point) <= highest_dew_point;
    without_dew_point += is_known ? 0 : 1;
    weather.hours[static_cast<std::size_t>(rows.last())].dew_point =
        is_known ? *dew_point : usual_dew_point;
  }
  const auto expected = static_cast<int>(weather.hours.size());
  if (rows.count() != expected) {
    file.fail(found.rows.empty() ? 1 : found.rows.back().first,
              fmt::format("the file has {} hours where a year has {}; it is cut short, or covers a "
                          "part of the year alone",
                          rows.count(), expected));
  }
  rows.note_missing();
  if (without_dew_point > 0) {
    weather.notes.push_back(fmt::format("{}: {} hours have no dew point; {:g} degrees are assumed",
                                        path.filename().string(), without_dew_point,
                                        usual_dew_point));
  }
  return weather;
}

}  // namespace lightwell
