#include "daylight/sky_year.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "scene/errors.h"
#include "scene/io/weather/sun_hours.h"
#include "scene/io/weather/weather_file.h"
#include "scene/parallel.h"
#include "scene/perez_sky.h"
#include "scene/sky_patch_means.h"
#include "scene/sun_position.h"

namespace lightwell {
namespace {

using std::numbers::pi;

// The patches of the dome, and means over them: the same in all hours.
struct DomeSamples {
  explicit DomeSamples(const SkyPatches& sky) : patches(sky), means(sky) {}

  const SkyPatches& patches;
  SkyPatchMeans means;
};

// Scales patches to `dome_lux` on open ground, and adds the ground, lit by `horizontal_lux`.
Eigen::ArrayXf scaled(const DomeSamples& samples, const Eigen::ArrayXd& dome, double dome_lux,
                      double horizontal_lux, double ground_reflectance) {
  const SkyPatches& patches = samples.patches;
  const double lux = (dome * samples.means.on_ground()).sum();
  Eigen::ArrayXf luminance(patches.column_count());
  luminance.head(dome.size()) = (dome * (lux > 0.0 ? dome_lux / lux : 0.0)).cast<float>();
  luminance[patches.ground_column()] = static_cast<float>(ground_reflectance * horizontal_lux / pi);
  return luminance;
}

Sky white_sky(const SkyPatches& patches) {
  return {.up = patches.up(), .north = patches.north(), .scale = Spectrum::Ones(1)};
}

Eigen::ArrayXf luminances_of(const DomeSamples& dome, const SkyHour& hour,
                             double ground_reflectance) {
  Sky sky = white_sky(dome.patches);
  sky.gradation = hour.gradation;
  sky.bright = hour.sun;
  return scaled(dome, dome.means.of(sky), hour.dome_lux, hour.horizontal_lux(dome.patches.up()),
                ground_reflectance);
}

}  // namespace

double SkyHour::horizontal_lux(const Eigen::Vector3d& up) const {
  return dome_lux + sun_lux * std::max(0.0, sun.dot(up));
}

namespace {

// Sun and sky of the hour `number` of the weather, with the sun where it is at `when`; empty: dark.
std::optional<SkyHour> sky_at(const Weather& weather, int number, const ClockTime& when,
                              const Sky& frame) {
  const WeatherHour& light = weather.hours[static_cast<std::size_t>(number)];
  const SunPosition sun = sun_position(when, weather.latitude, weather.longitude);
  const double altitude = sun.altitude_degrees;
  if (!(altitude > 0.0) || !(light.diffuse_horizontal > 0.0)) return std::nullopt;
  const int day = day_of_year(when.year, when.month, when.day);
  const SkyState state =
      within_data(sky_state(light.direct_normal, light.diffuse_horizontal, altitude, day));
  const DaylightEfficacy efficacy =
      perez_efficacy(state, altitude, precipitable_water_cm(light.dew_point));
  return SkyHour{.number = number,
                 .sun = sky_direction(frame, sun.azimuth_degrees, altitude),
                 .altitude_degrees = altitude,
                 .azimuth_degrees = sun.azimuth_degrees,
                 .sun_lux = light.direct_normal * efficacy.direct,
                 .dome_lux = light.diffuse_horizontal * efficacy.diffuse,
                 .gradation = perez_sky(state, altitude)};
}

}  // namespace

std::vector<SkyHour> sky_hours(const Weather& weather, const Eigen::Vector3d& up,
                               const Eigen::Vector3d& north) {
  const Sky frame{.up = up, .north = north};
  std::vector<SkyHour> hours;
  for (int n = 0; n < static_cast<int>(weather.hours.size()); ++n) {
    const auto [month, day, hour] = hour_of_year(n, weather.is_leap_year);
    const ClockTime middle{.year = year_of_dates(weather.is_leap_year),
                           .month = month,
                           .day = day,
                           .hour = hour + 0.5,
                           .hours_east = weather.hours_east};
    if (const auto sky = sky_at(weather, n, middle, frame)) hours.push_back(*sky);
  }
  return hours;
}

std::optional<SkyHour> sky_instant(const Weather& weather, const ClockTime& when,
                                   const Eigen::Vector3d& up, const Eigen::Vector3d& north) {
  const int number =
      number_of({.month = when.month, .day = when.day, .hour = static_cast<int>(when.hour)},
                weather.is_leap_year);
  if (number < 0) {
    throw InputError(
        fmt::format("{}: the weather has no hour on day {} of month {}; give another date",
                    weather.file.string(), when.day, when.month));
  }
  ClockTime standard = when;
  standard.hours_east = weather.hours_east;
  return sky_at(weather, number, standard, {.up = up, .north = north});
}

void require_light(const Weather& weather, const std::vector<SkyHour>& hours) {
  if (!hours.empty()) return;
  throw InputError(fmt::format(
      "{}: no hour has the sun above the horizon and light of the dome, so there is no daylight to "
      "compute; give a file whose diffuse horizontal irradiances are known, and whose latitude, "
      "longitude and time zone are those of one place",
      weather.file.string()));
}

std::string note_on_dark_hours(const Weather& weather, const std::vector<SkyHour>& hours) {
  double all = 0.0, kept = 0.0;
  int with_light = 0;
  for (const WeatherHour& hour : weather.hours) {
    const double light = hour.direct_normal + hour.diffuse_horizontal;
    with_light += light > 0.0 ? 1 : 0;
    all += light;
  }
  for (const SkyHour& hour : hours) {
    const WeatherHour& light = weather.hours[static_cast<std::size_t>(hour.number)];
    kept += light.direct_normal + light.diffuse_horizontal;
  }
  const int dark = with_light - static_cast<int>(hours.size());
  if (dark <= 0) return {};
  const double lost = (all - kept) / all;
  // An hour of twilight has the sun for less than half of it, lower than 7.5 degrees.
  constexpr double more_than_twilight = 0.02;
  return fmt::format(
      "{} hours of the file with light, {:.2g} % of the year's irradiance, have the sun below the "
      "horizon in their middle, or no light of the dome; they count as dark{}",
      dark, 100.0 * lost,
      lost > more_than_twilight
          ? ". That is more than twilight: check the file's latitude, longitude and time zone"
          : "");
}

Eigen::ArrayXf column_luminances(const SkyPatches& patches, const SkyHour& hour,
                                 double ground_reflectance) {
  return luminances_of(DomeSamples(patches), hour, ground_reflectance);
}

BandArray hour_luminances(const SkyPatches& sky, std::span<const SkyHour> hours,
                          double ground_reflectance) {
  BandArray luminance(sky.column_count(), static_cast<Eigen::Index>(hours.size()));
  const DomeSamples dome(sky);
  constexpr int grain = 8;
  parallel_for(static_cast<int>(hours.size()), grain, [&](int begin, int end) {
    for (int h = begin; h < end; ++h) {
      luminance.col(h) =
          luminances_of(dome, hours[static_cast<std::size_t>(h)], ground_reflectance);
    }
  });
  return luminance;
}

Eigen::ArrayXf overcast_luminances(const SkyPatches& patches, double ground_reflectance) {
  Sky sky = white_sky(patches);
  sky.kind = SkyKind::overcast;
  const DomeSamples dome(patches);
  return scaled(dome, dome.means.of(sky), 1.0, 1.0, ground_reflectance);
}

}  // namespace lightwell
