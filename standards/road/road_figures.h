#pragma once

#include <optional>
#include <string>
#include <vector>

#include "raytrace/readings/lux_grid.h"
#include "standards/requirement.h"
#include "standards/road/road.h"

namespace lightwell {

/// Values over a grid of a road or of a strip beside it.
struct RoadField {
  std::string name{};  ///< of the strip: "carriageway", "footway"
  LuxGrid grid{};      ///< corner and axes in the frame of Road
  LuxField field{};    ///< with maintenance; lx, or cd/m^2 of luminance
};

/// Figures of EN 13201-3 for the driver of a lane.
struct RoadObserver {
  int lane = 1;  ///< from the right
  bool is_oncoming = false;
  Eigen::Vector3d eye = Eigen::Vector3d::Zero();  ///< m, 60 m before the field
  double luminance = 0.0;                         ///< L_m, cd/m^2, with maintenance
  double uniformity = 0.0;                        ///< U_o = L_min / L_m
  double longitudinal_uniformity = 0.0;           ///< U_l = L_min / L_max along the lane's middle
  std::optional<double> wet_uniformity{};         ///< U_o of the wet surface
  double threshold_increment = 0.0;               ///< greatest f_TI, percent, of new luminaires
  double glare_eye_x = 0.0;                       ///< m, where the eye of that f_TI is
};

/// Mean illuminance beside an edge of the carriageway over that within, each on a strip as wide as
/// a lane.
struct EdgeRatio {
  bool is_left = false;
  double value = 0.0;
  bool is_required = true;  ///< false: a strip with a class of its own, or a median, is there
};

/// Figures of a lit road.
struct RoadFigures {
  std::vector<RoadObserver> observers{};
  std::size_t worst = 0;                 ///< the observer of the least mean luminance
  RoadField luminance{};                 ///< for the worst observer
  std::vector<RoadField> illuminance{};  ///< of the carriageway, then of each strip
  std::vector<EdgeRatio> edges{};        ///< right, left
  std::vector<Requirement> requirements{};
  /// Power over lit area and illuminance, W/(lx m^2) (EN 13201-5: D_P), and energy of a year,
  /// kWh/m^2 (D_E), over the carriageways and strips that have a class; a strip in the median
  /// counts once. Empty: power or hours are not known.
  std::optional<double> power_density{}, energy{};
  double watts_per_km = 0.0;  ///< 0: power is not known

  bool meets_all() const { return verdict_of(requirements) == Verdict::met; }
};

/// Computes the figures of a road with direct light, as EN 13201-3:2015 does, and holds them to the
/// road's classes. The figures are sums of the tables' values, so their bounds are those of
/// rounding, 0.
RoadFigures road_figures(const Road& road);

/// Illuminance of the carriageway, of all strips and of a lane's width beside them, lx, at points
/// about half a metre apart, at most 400 along and across, for a drawing.
RoadField illuminance_map(const Road& road);

/// The points of a strip for EN 13201-3: `width` from `right` (m, y) between two luminaires of a
/// row, in 10 columns, or as many as keep them 3 m apart. `rows` >= 1.
LuxGrid road_grid(const Road& road, double right, double width, int rows);

/// Rows of illuminance across a strip, m: at least 3, at most 1.5 m apart.
int illuminance_rows(double width);

/// Right edge of a strip, m along y.
double right_edge(const Road& road, const RoadStrip& strip);

}  // namespace lightwell
