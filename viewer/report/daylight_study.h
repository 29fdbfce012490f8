#pragma once

#include <Eigen/Core>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "daylight/annual_metrics.h"
#include "daylight/daylight_model.h"
#include "daylight/sun_exposure.h"
#include "daylight/window_operation.h"
#include "mesh/cleaning/planar_regions.h"
#include "raytrace/readings/probe.h"
#include "scene/io/lighting_design.h"
#include "scene/io/room_use.h"
#include "scene/io/sensor_grids.h"
#include "scene/io/weather/weather_file.h"
#include "scene/io/window_states.h"
#include "viewer/report/requested_grids.h"
#include "viewer/report/year_report.h"

namespace lightwell {

/// A scene, the weather of a year, and what is asked of both. Lengths in metres.
struct DaylightStudy {
  std::string version{};  ///< of the program
  Weather weather{};
  CleanUpReport clean_up{};
  Scene scene{};  ///< after merge_planar_regions(), whose report is `clean_up`
  OperatedWindows windows{};
  GridRequest request{};                      ///< surfaces and planes with sensors
  std::vector<CalculationGrid> grids{};       ///< of the scene file
  std::vector<SensorGrid> sensor_grids{};     ///< of the scene file
  std::vector<Probe> points{};                ///< sensors one by one, a room of their own
  std::string points_name{};                  ///< of that room
  std::vector<Camera> eyes{};                 ///< observers of glare
  std::vector<Eigen::Vector3d> sun_points{};  ///< of exposure to sunlight
  ExposureDay sun_day{};
  Eigen::Vector3d up = Eigen::Vector3d::UnitZ(), north = Eigen::Vector3d::UnitY();
  bool has_north = false;                 ///< by a sky of the scene
  std::vector<RoomUse> rooms{};           ///< empty: their use is not told
  std::vector<DaylightRating> ratings{};  ///< that are asked for
  double ground_reflectance = 0.2;
  Occupancy occupancy{};
  DaylightOptions options{};

  /// The scene with the surfaces of its file, which the clean-up may have joined.
  Scene scene_apart() const;
};

/// Sets zenith and north: see compass_of().
void set_compass(double north_degrees, DaylightStudy& study);

/// Throws InputError for a study without sensors, for surfaces that are not there, and for operated
/// windows that the clean-up made a part of another surface: before the work, which takes long.
void check_study(const DaylightStudy& study);

/// The sensors of all rooms, in order, and those of the eyes behind them.
struct DaylightSensors {
  std::vector<Probe> probes{};  ///< of the rooms
  std::vector<Probe> eyes{};
  std::vector<YearRoom> rooms{};

  std::vector<Probe> all() const;
  std::vector<SensorRange> ranges() const;
};

/// The sensors of a study. `caster` is of its mesh. Throws what requested_grids() throws.
DaylightSensors daylight_sensors(const DaylightStudy& study, const ElementCaster& caster);

/// The model of a study, and its sensors.
struct StudiedModel {
  std::unique_ptr<DaylightModel> model{};
  DaylightSensors sensors{};
};

/// The model for the year, with the use of its rooms. Refuses uses and ratings that do not fit the
/// rooms before form factors, which take long. Throws InputError, and Interrupted when progress
/// says stop.
StudiedModel model_of_year(const DaylightStudy& study, const Progress& progress);
/// The model for instants, whose sensors are those of the rooms alone.
StudiedModel model_of_instants(const DaylightStudy& study, const Progress& progress);

/// Assumptions, a sentence each, but for the sentences on hour, sun and date.
std::vector<std::string> daylight_conventions(const DaylightStudy& study, const SkyPatches& sky);

/// Title, weather, occupancy and notes, with `notes` before those of the scene.
YearReport daylight_report(const DaylightStudy& study, const std::vector<std::string>& notes);

}  // namespace lightwell
