#include "scene/io/weather/clock_time.h"

#include <fmt/format.h>

#include <sstream>

#include "scene/errors.h"
#include "scene/io/weather/weather_file.h"

namespace lightwell {

ClockTime read_clock_time(const std::string& text) {
  std::istringstream words(text);
  ClockTime when;
  int hour = -1, minute = -1;
  char first = ' ', second = ' ', between = ' ', colon = ' ';
  words >> when.year >> first >> when.month >> second >> when.day;
  words.get(between);
  words >> hour >> colon >> minute;
  const bool is_whole = !words.fail() && words.peek() == std::istringstream::traits_type::eof() &&
                        first == '-' && second == '-' && colon == ':' &&
                        (between == ' ' || between == 'T');
  constexpr int first_year = 1950, last_year = 2050;  // of the sun's position
  const bool is_leap_year = when.year % 4 == 0 && (when.year % 100 != 0 || when.year % 400 == 0);
  if (!is_whole || when.year < first_year || when.year > last_year || hour < 0 || hour > 23 ||
      minute < 0 || minute > 59 ||
      number_of({.month = when.month, .day = when.day}, is_leap_year) < 0) {
    throw InputError(
        fmt::format("'{}' is no instant from {} to {}; write date and standard time, such as "
                    "\"2024-11-21 15:30\"",
                    text, first_year, last_year));
  }
  when.hour = hour + minute / 60.0;
  return when;
}

}  // namespace lightwell
