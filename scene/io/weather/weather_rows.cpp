#include "scene/io/weather/weather_rows.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace lightwell {
namespace {

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

void WeatherRows::set(int line, const HourOfYear& hour, std::string_view direct,
                      std::string_view diffuse) {
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
  weather_.hours[at].direct_normal = light(line, direct, "direct normal");
  weather_.hours[at].diffuse_horizontal = light(line, diffuse, "diffuse horizontal");
}

double WeatherRows::light(int line, std::string_view word, const char* name) {
  // The files' mark of a missing irradiance.
  constexpr double missing = 9999.0;
  const auto value = word.empty() ? std::optional<double>(missing) : parse_finite(word);
  if (!value || *value < 0.0) {
    file_.fail(line, fmt::format("the {} irradiance is '{}'; it is a number of W/m2 from 0 on, or "
                                 "9999 where it is missing",
                                 name, excerpt(word)));
  }
  if (*value < missing) return *value;
  ++missing_;
  return 0.0;
}

void WeatherRows::note_missing() const {
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
