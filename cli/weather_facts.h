#pragma once

#include "cli/report.h"
#include "scene/io/weather/weather_file.h"

namespace lightwell {

/// True for the extensions of read_weather().
bool is_weather_file(const std::filesystem::path& file);

/// Place, hours and light of a year, for `info`: sums of irradiance over the year, kWh/m^2, and the
/// light of the hours by sky_hours(), klx h.
Json weather_json(const Weather& weather);

}  // namespace lightwell
