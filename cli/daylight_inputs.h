#pragma once

#include <optional>
#include <string>
#include <vector>

#include "cli/arguments.h"
#include "cli/console.h"
#include "cli/grid_arguments.h"
#include "cli/report.h"
#include "scene/sun_position.h"
#include "viewer/report/daylight_study.h"

namespace lightwell {

/// Arguments of 'lightwell daylight'.
struct DaylightArguments {
  std::string scene, weather, points, windows, sun_points, output, walk;
  std::string rooms{}, rating_table{};
  std::vector<std::string> observers{}, ratings{};
  GridArguments grids{};
  MeshArguments mesh{};
  double north_degrees = 0.0, ground = 0.2;
  int sky = DaylightOptions{}.sky_subdivision, rays = DaylightOptions{}.gather_rays;
  bool hourly = false;
  Occupancy occupancy{};
  ExposureDay sun_day{};
  std::optional<ClockTime> at{};  ///< an instant in place of the year
  std::string at_text{};
};

/// Reads the inputs of the command.
DaylightStudy read_daylight_study(const DaylightArguments& arguments, Console& console,
                                  Report& report);

}  // namespace lightwell
