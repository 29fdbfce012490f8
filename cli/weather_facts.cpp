#include "cli/weather_facts.h"

#include <algorithm>

#include "daylight/sky_year.h"
#include "scene/io/text_file.h"

namespace lightwell {

bool is_weather_file(const std::filesystem::path& file) {
  const std::string extension = lower_extension(file);
  return extension == ".epw" || extension == ".wea";
}

Json weather_json(const Weather& weather) {
  constexpr double kilo = 1e3;
  const Eigen::Vector3d up = Eigen::Vector3d::UnitZ(), north = Eigen::Vector3d::UnitY();
  const std::vector<SkyHour> hours = sky_hours(weather, up, north);
  double direct = 0.0, diffuse = 0.0, horizontal = 0.0, brightest = 0.0;
  for (const WeatherHour& hour : weather.hours) {
    direct += hour.direct_normal;
    diffuse += hour.diffuse_horizontal;
  }
  for (const SkyHour& hour : hours) {
    horizontal += hour.horizontal_lux(up);
    brightest = std::max(brightest, hour.horizontal_lux(up));
  }
  std::vector<std::string> notes = weather.notes;
  const std::string dark = note_on_dark_hours(weather, hours);
  if (!dark.empty()) notes.push_back(dark);
  return {{"kind", "weather"},
          {"format", weather.format},
          {"place", weather.place},
          {"latitude", weather.latitude},
          {"longitude", weather.longitude},
          {"hours_east", weather.hours_east},
          {"hours", weather.hours.size()},
          {"hours_with_light", hours.size()},
          {"direct_normal_kWh_m2", direct / kilo},
          {"diffuse_horizontal_kWh_m2", diffuse / kilo},
          {"horizontal_klx_h", horizontal / kilo},
          {"brightest_hour_klx", brightest / kilo},
          {"notes", notes}};
}

}  // namespace lightwell
