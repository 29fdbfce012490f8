#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "cli/arguments.h"
#include "cli/console.h"
#include "cli/grid_arguments.h"
#include "cli/report.h"
#include "daylight/annual_metrics.h"
#include "daylight/daylight_model.h"
#include "daylight/sun_exposure.h"
#include "daylight/window_operation.h"
#include "mesh/cleaning/planar_regions.h"
#include "raytrace/readings/probe.h"
#include "scene/io/room_use.h"
#include "scene/io/sensor_grids.h"
#include "scene/io/weather/weather_file.h"
#include "scene/io/window_states.h"
#include "scene/sun_position.h"
#include "viewer/report/year_report.h"

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

/// Inputs of the command.
struct DaylightInputs {
  Weather weather{};
  CleanUpReport clean_up{};
  Scene scene{};
  OperatedWindows windows{};
  std::vector<SensorGrid> grids{};            ///< of the scene file
  std::vector<Probe> points{};                ///< of --points
  std::vector<Camera> eyes{};                 ///< observers of glare
  std::vector<Eigen::Vector3d> sun_points{};  ///< m, of exposure to sunlight
  Eigen::Vector3d up = Eigen::Vector3d::UnitZ(), north = Eigen::Vector3d::UnitY();
  bool has_north = false;                 ///< by a sky of the scene
  std::vector<RoomUse> rooms{};           ///< of --rooms
  std::vector<DaylightRating> ratings{};  ///< that are asked for

  /// The scene with the surfaces of its file, which the clean-up may have joined.
  Scene scene_apart() const;
};

DaylightInputs read_daylight_inputs(const DaylightArguments& arguments, Console& console,
                                    Report& report);

/// The sensors of all rooms, in order, and those of the eyes behind them.
struct DaylightSensors {
  std::vector<Probe> probes{};  ///< of the rooms
  std::vector<Probe> eyes{};
  std::vector<YearRoom> rooms{};

  std::vector<Probe> all() const;
  std::vector<SensorRange> ranges() const;
};

DaylightSensors daylight_sensors(const DaylightArguments& arguments, const DaylightInputs& inputs,
                                 const ElementCaster& caster);

DaylightOptions daylight_options(const DaylightArguments& arguments, const Scene& scene,
                                 Console& console);

/// Assumptions, a sentence each, but for the sentences on hour, sun and date.
std::vector<std::string> daylight_conventions(const DaylightArguments& arguments,
                                              const DaylightInputs& inputs, const SkyPatches& sky);

/// Title, weather, conventions and notes, with `notes` before those of the scene.
YearReport daylight_report(const DaylightArguments& arguments, const DaylightInputs& inputs,
                           const std::vector<std::string>& notes);

}  // namespace lightwell
