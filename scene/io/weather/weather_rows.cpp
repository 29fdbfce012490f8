#include "scene/io/weather/weather_rows.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "scene/io/weather/sun_hours.h"
#include "scene/sun_position.h"

namespace lightwell {
namespace {

constexpr double most_direct = 1100.0;  // W/m^2 across the rays, at noon on a high mountain

constexpr std::array<int, 12> days_of_months = {31, 28, 31, 30, 31, 30, 31, 31, 30, 31, 30, 31};

int days_of(int month, bool is_leap_year) {
  const int days = days_of_months[static_cast<std::size_t>(month - 1)];
  return month == 2 && is_leap_year ? days + 1 : days;
}

}  // namespace

HourOfYear hour_of_year(int number, bool is_leap_year) {
  int day = number / hours_a_day + 1, month = 1;
  while (month < 12 && day > days_of(month, is_leap_year)) day -= days_of(month++, is_leap_year);
  return {.month = month, .day = day, .hour = number % hours_a_day};
}

int number_of(const HourOfYear& hour, bool is_leap_year) {
  if (hour.month < 1 || hour.month > 12 || hour.hour < 0 || hour.hour >= hours_a_day) return -1;
  if (hour.day < 1 || hour.day > days_of(hour.month, is_leap_year)) return -1;
  int days = hour.day - 1;
  for (int month = 1; month < hour.month; ++month) days += days_of(month, is_leap_year);
  return hours_a_day * days + hour.hour;
}

WeatherRows::WeatherRows(const TextFile& file, Weather& weather)
    : file_(file),
      weather_(weather),
      is_set_(static_cast<std::size_t>(weather.is_leap_year ? 8784 : 8760), 0) {
  weather.hours.resize(is_set_.size());
}

void WeatherRows::set(int line, const HourOfYear& hour, const IrradianceWords& words) {
  const int number = number_of(hour, weather_.is_leap_year);
  if (number < 0) {
    file_.fail(line, fmt::format("month {}, day {}, hour {} is no hour of {}", hour.month, hour.day,
                                 hour.hour, weather_.is_leap_year ? "a leap year" : "the year"));
  }
  const auto at = static_cast<std::size_t>(number);
  if (is_set_[at] != 0) {
    file_.fail(line, fmt::format("is a second row of the hour from {}:00 of day {} of month {}; "
                                 "weather files have one row for each hour here",
                                 hour.hour, hour.day, hour.month));
  }
  is_set_[at] = 1;
  ++count_;
  last_ = number;
  auto direct = light(line, words.direct_normal, "direct normal");
  auto diffuse = light(line, words.diffuse_horizontal, "diffuse horizontal");
  const bool is_one_missing = direct.has_value() != diffuse.has_value();
  const auto global = is_one_missing ? light(line, words.global_horizontal, "global horizontal")
                                     : std::optional<double>();
  const double sine = global ? sine_of_altitude(hour) : 0.0;
  if (global && !diffuse && sine > 0.0) {
    diffuse = std::max(0.0, *global - sine * *direct);
    ++derived_;
  } else if (global && !direct && sine > 0.0 && *global >= *diffuse) {
    // Rounded irradiances of a sun on the horizon would tell any direct light.
    direct = std::min((*global - *diffuse) / sine, most_direct);
    ++derived_;
  }
  missing_ += (direct ? 0 : 1) + (diffuse ? 0 : 1);
  weather_.hours[at].direct_normal = direct.value_or(0.0);
  weather_.hours[at].diffuse_horizontal = diffuse.value_or(0.0);
}

// Sine of the altitude of the sun in the middle of an hour.
double WeatherRows::sine_of_altitude(const HourOfYear& hour) const {
  const SunPosition sun = sun_position({.year = year_of_dates(weather_.is_leap_year),
                                        .month = hour.month,
                                        .day = hour.day,
                                        .hour = hour.hour + 0.5,
                                        .hours_east = weather_.hours_east},
                                       weather_.latitude, weather_.longitude);
  return std::sin(sun.altitude_degrees * std::numbers::pi / 180.0);
}

std::optional<double> WeatherRows::light(int line, std::string_view word, const char* name) const {
  // The files' mark of a missing irradiance.
  constexpr double missing = 9999.0;
  const auto value = word.empty() ? std::optional<double>(missing) : parse_finite(word);
  if (!value || *value < 0.0) {
    file_.fail(line, fmt::format("the {} irradiance is '{}'; it is a number of W/m2 from 0 on, or "
                                 "9999 where it is missing",
                                 name, excerpt(word)));
  }
  return *value < missing ? value : std::nullopt;
}

void WeatherRows::note_missing() const {
  if (derived_ > 0) {
    weather_.notes.push_back(
        fmt::format("{}: {} irradiances, direct or diffuse, are missing (9999) and follow from the "
                    "global ones",
                    file_.path().filename().string(), derived_));
  }
  if (missing_ == 0) return;
  weather_.notes.push_back(
      fmt::format("{}: {} irradiances are missing (9999) and count as 0, so the year is too dark",
                  file_.path().filename().string(), missing_));
}

void check_place(const TextFile& file, int line, const Weather& weather) {
  const auto check = [&](const char* name, double value, double most) {
    if (std::abs(value) <= most) return;
    file.fail(line, fmt::format("the {} is {:g}; it lies between {:g} and {:g}", name, value, -most,
                                most));
  };
  check("latitude", weather.latitude, 90.0);
  check("longitude", weather.longitude, 180.0);
  check("time zone", weather.hours_east, 14.0);
}

}  // namespace lightwell
