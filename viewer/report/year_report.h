#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "daylight/annual_metrics.h"
#include "daylight/daylight_glare.h"
#include "daylight/sun_exposure.h"
#include "raytrace/readings/lux_grid.h"
#include "scene/io/room_use.h"
#include "scene/io/weather/weather_file.h"
#include "standards/daylight_rating.h"
#include "viewer/report/plan_lines.h"

namespace lightwell {

/// Hours of the year in which a room has the illuminances of a rating.
struct RatedHours {
  BoundedFigure mean{}, point{};
};

/// Occupied hours of a room's lamps.
struct LampHours {
  int daylight_hours = 0, night_hours = 0;  ///< t_D and t_N
  BoundedFigure daylight_dependency{};      ///< F_D, see LampUse
};

/// Sensors that are judged together: those of a grid, or of a file of points.
struct YearRoom {
  std::string name{};
  std::optional<LuxGrid> grid{};
  PlanLines lines{};                  ///< for the plan of a grid
  Eigen::Index first = 0, count = 0;  ///< of all sensors
  /// The measures, and those of less and of more light by the bound of its error.
  RoomMetrics metrics{}, least{}, most{};
  std::vector<float> mean_of_hours{};      ///< lx, for every hour of the year
  double area = 0.0;                       ///< of the floor, m^2; 0: not known
  bool is_regularly_occupied = true;       ///< false: ratings do not count the room
  std::vector<RatedHours> rated_hours{};   ///< like YearReport::ratings
  std::optional<RoomLighting> lighting{};  ///< empty: not asked for
  LampHours lamps{};                       ///< of `lighting`
};

/// A group of windows that is operated, and the hours that it spends in its states.
struct YearWindows {
  std::string name{};
  std::string operation{};  ///< the rule, see operation_text()
  struct State {
    std::string name{};
    int occupied_hours = 0, hours = 0;  ///< hours with light
  };
  std::vector<State> states{};
};

/// The year with the windows in the same states in all hours.
struct YearInStates {
  std::string states{};  ///< see states_text()
  double error = 0.0;    ///< see year_error()
  std::vector<RoomMetrics> rooms{};
};

/// Hours with the sun in sight on a day, at points where they are asked for.
struct YearExposure {
  ExposureDay day{};
  std::vector<Eigen::Vector3d> points{};  ///< m
  Eigen::ArrayXd hours{};
};

/// A year of daylight.
struct YearReport {
  std::string title{}, version{};
  Weather weather{};
  double error = 0.0;                      ///< see year_error()
  std::vector<std::string> conventions{};  ///< what is assumed, a sentence each
  std::vector<std::string> notes{};
  Occupancy occupancy{};
  std::optional<Eigen::Vector3d> north{};
  double metres_per_unit = 1.0;
  std::string unit_name = "m";
  SensorMetrics sensors{};
  Eigen::ArrayXf daylight_factor{};  ///< [0, 1]
  std::vector<YearRoom> rooms{};
  std::vector<YearWindows> windows{};  ///< empty: nothing is operated
  std::vector<YearInStates> states{};  ///< that the year was put together from
  bool is_superposed = false;          ///< see WindowPlan
  double superposition = 0.0;          ///< see OperatedYear
  std::vector<int> hour_numbers{};     ///< of the hours with light, see SkyHour
  std::vector<GlareOfYear> glare{};    ///< of observers
  std::optional<YearExposure> exposure{};
  std::vector<DaylightRating> ratings{};  ///< that the rooms are held to
};

/// Measures, bounds and conventions.
nlohmann::ordered_json year_json(const YearReport& report);

/// The figures that people look for first, a line each.
std::string year_text(const YearReport& report);

/// The report as one HTML page without external files, for screens and for A4 paper.
std::string year_page(const YearReport& report);

}  // namespace lightwell
