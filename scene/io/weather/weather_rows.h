#pragma once

#include <string_view>
#include <vector>

#include "scene/io/text_file.h"
#include "scene/io/weather/weather_file.h"

namespace lightwell {

/// Puts the rows of a weather file into the hours of a year, and counts what is missing.
class WeatherRows {
 public:
  /// `weather` gets hours of a year without light.
  WeatherRows(const TextFile& file, Weather& weather);

  /// Sets an hour from the words of line `line`; a word that is empty is missing. Throws
  /// InputError for a date that does not exist, a second row of an hour, and light that is no
  /// number or negative.
  void set(int line, const HourOfYear& hour, std::string_view direct, std::string_view diffuse);

  int count() const { return count_; }
  /// The hour that was set last.
  int last() const { return last_; }
  /// Adds a note on missing values.
  void note_missing() const;

 private:
  double light(int line, std::string_view word, const char* name);

  const TextFile& file_;
  Weather& weather_;
  std::vector<char> is_set_;
  int count_ = 0, last_ = -1, missing_ = 0;
};

/// Throws InputError at `line` unless the place lies on the earth.
void check_place(const TextFile& file, int line, const Weather& weather);

}  // namespace lightwell
