#include "daylight/sun_exposure.h"

#include <fmt/format.h>

#include <utility>

#include "radiosity/visibility/clear_panes.h"
#include "scene/errors.h"
#include "scene/io/dashed_pair.h"
#include "scene/parallel.h"
#include "scene/sun_position.h"

namespace lightwell {
namespace {

constexpr int minutes_of_hour = 60, minutes_of_day = hours_a_day * minutes_of_hour;

// Directions to the sun in the middle of each minute in which it counts.
std::vector<Eigen::Vector3d> suns_of_day(const SkyPatches& sky, const Weather& weather,
                                         const ExposureDay& day) {
  constexpr int exposure_year = 2017;
  const Sky frame{.up = sky.up(), .north = sky.north()};
  std::vector<Eigen::Vector3d> suns;
  for (int minute = 0; minute < minutes_of_day; ++minute) {
    const SunPosition sun = sun_position({.year = exposure_year,
                                          .month = day.month,
                                          .day = day.day,
                                          .hour = (minute + 0.5) / minutes_of_hour,
                                          .hours_east = weather.hours_east},
                                         weather.latitude, weather.longitude);
    if (sun.altitude_degrees > day.least_altitude_degrees) {
      suns.push_back(sky_direction(frame, sun.azimuth_degrees, sun.altitude_degrees));
    }
  }
  return suns;
}

}  // namespace

ExposureDay read_exposure_day(const std::string& text) {
  const auto date = dashed_pair(text);
  if (!date || number_of({.month = date->first, .day = date->second}, false) < 0) {
    throw InputError(fmt::format("'{}' is no day; write month and day, such as 03-21", text));
  }
  if (*date < std::pair(2, 1) || *date > std::pair(3, 21)) {
    throw InputError(
        fmt::format("'{}' is none of the days of EN 17037; write one from 02-01 to 03-21", text));
  }
  return {.month = date->first, .day = date->second};
}

Eigen::ArrayXd sun_exposure(const DaylightModel& model, const Weather& weather,
                            std::span<const Eigen::Vector3d> points, const ExposureDay& day) {
  const std::vector<Eigen::Vector3d> suns = suns_of_day(model.sky(), weather, day);
  const ClearPanes panes(model.scene());
  Eigen::ArrayXd hours = Eigen::ArrayXd::Zero(static_cast<Eigen::Index>(points.size()));
  parallel_for(static_cast<int>(points.size()), 1, [&](int begin, int end) {
    for (int p = begin; p < end; ++p) {
      int minutes = 0;
      for (const Eigen::Vector3d& sun : suns) {
        const Ray ray{.origin = points[static_cast<std::size_t>(p)], .direction = sun};
        std::uint8_t blocked = 0;
        model.caster().occluded({&ray, 1}, {&blocked, 1});
        const bool is_seen =
            blocked == 0 || (!panes.empty() && (panes.passed(model.caster(), ray) > 0.0f).any());
        minutes += is_seen ? 1 : 0;
      }
      hours[p] = static_cast<double>(minutes) / minutes_of_hour;
    }
  });
  return hours;
}

std::string exposure_level(double hours) {
  constexpr double minimum = 1.5, medium = 3.0, high = 4.0;
  return hours >= high      ? "high"
         : hours >= medium  ? "medium"
         : hours >= minimum ? "minimum"
                            : "none";
}

}  // namespace lightwell
