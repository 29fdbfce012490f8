#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include "scene/io/text_file.h"
#include "scene/io/weather/weather_file.h"

namespace lightwell {

/// Words of a row for irradiances, W/m^2; empty or 9999: missing.
struct IrradianceWords {
  std::string_view direct_normal{}, diffuse_horizontal{};
  std::string_view global_horizontal{};  ///< tells one of the others if that is missing
};

/// Puts the rows of a weather file into the hours of a year, and counts what is missing.
class WeatherRows {
 public:
  /// `weather` gets hours of a year without light.
  WeatherRows(const TextFile& file, Weather& weather);

  /// Sets an hour from the words of line `line`. With one of direct and diffuse light missing,
  /// global = direct sin(altitude) + diffuse gives it, for the sun in the middle of the hour.
  /// Throws InputError for a date that does not exist, a second row of an hour, and light that is
  /// no number or negative.
  void set(int line, const HourOfYear& hour, const IrradianceWords& words);

  int count() const { return count_; }
  /// The hour that was set last.
  int last() const { return last_; }
  /// Adds a note on missing values.
  void note_missing() const;

 private:
  std::optional<double> light(int line, std::string_view word, const char* name) const;
  double sine_of_altitude(const HourOfYear& hour) const;

  const TextFile& file_;
  Weather& weather_;
  std::vector<char> is_set_;
  int count_ = 0, last_ = -1, missing_ = 0, derived_ = 0;
};

/// Throws InputError at `line` unless the place lies on the earth.
void check_place(const TextFile& file, int line, const Weather& weather);

}  // namespace lightwell
