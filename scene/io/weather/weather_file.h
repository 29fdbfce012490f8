#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace lightwell {

/// The dew point where a file has none, degrees Celsius: 2 cm of water in the air, as RADIANCE's
/// gendaymtx has.
inline constexpr double usual_dew_point = 11.0;

/// Sunlight and sky light of an hour, means over the hour.
struct WeatherHour {
  double direct_normal = 0.0;          ///< W/m^2 across the sun's rays, >= 0
  double diffuse_horizontal = 0.0;     ///< W/m^2 of the dome on open level ground, >= 0
  double dew_point = usual_dew_point;  ///< degrees Celsius
};

/// A place, and the light there in every hour of a year.
struct Weather {
  std::filesystem::path file{};
  std::string format{};  ///< "EnergyPlus (EPW)", "RADIANCE (WEA)"
  std::string place{};
  double latitude = 0.0;    ///< degrees north, [-90, 90]
  double longitude = 0.0;   ///< degrees east, [-180, 180]
  double hours_east = 0.0;  ///< standard time less UTC, [-14, 14]
  bool is_leap_year = false;
  /// Hour h of the year, from 0, spans h to h + 1 in standard time; 8760 or, of leap years, 8784.
  std::vector<WeatherHour> hours{};
  std::vector<std::string> notes{};  ///< what was missing and what is assumed, one sentence each
};

inline constexpr int hours_a_day = 24;

/// Date and hour of the day of an hour of the year.
struct HourOfYear {
  int month = 1, day = 1, hour = 0;
};
HourOfYear hour_of_year(int number, bool is_leap_year);

/// Number of an hour of the year; -1 for a date that does not exist.
int number_of(const HourOfYear& hour, bool is_leap_year);

/// Reads hourly weather: EnergyPlus' .epw or RADIANCE's .wea, by the extension. Values of an EPW
/// row hold for the hour that ends at its label; a WEA row names the middle of its hour. Values
/// that are missing are 0, with a note, unless a row's global light tells its direct or diffuse
/// light; hours that a WEA file leaves out are dark. Throws InputError naming file, line, fault and
/// remedy.
Weather read_weather(const std::filesystem::path& path);

/// The two formats of read_weather().
Weather read_epw(const std::filesystem::path& path);
Weather read_wea(const std::filesystem::path& path);

}  // namespace lightwell
