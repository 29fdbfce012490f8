#pragma once

#include <optional>
#include <string>
#include <vector>

#include "raytrace/glare.h"
#include "raytrace/lux_grid.h"
#include "viewer/export/appearance.h"

namespace lightwell {

/// A line of the list of luminaires: all emitters of one name.
struct LuminaireRow {
  std::string name{};
  int count = 0;       ///< surfaces or lamps
  double flux = 0.0;   ///< lm, of all `count` emitters, with the solution's channel scales
  double watts = 0.0;  ///< installed electric power of all `count` emitters, W; 0: unknown
};

/// Illuminance on a grid of points.
struct CalculationSurface {
  LuxGrid grid{};
  LuxField field{};
};

/// Unified glare rating for a camera's eye.
struct Observer {
  std::string name{};
  Glare glare{};
};

/// Installed power of all luminaires over the area of a working plane, in the two units of EN
/// 15193: W/m^2, and W/m^2 for each 100 lx of maintained illuminance.
struct PowerDensity {
  double watts_per_area = 0.0;   ///< W/m^2
  double per_hundred_lux = 0.0;  ///< W/m^2 for each 100 lx of E_m
};

/// Contents of a lighting report.
struct LightingReport {
  std::string title{};
  Provenance provenance{};
  double metres_per_unit = 1.0;
  std::string unit_name = "m";
  double maintenance_factor = 1.0;
  int rays = 0;                 ///< gather rays per point
  double error_estimate = 0.0;  ///< of the solution, relative RMS; 0: unknown
  std::vector<LuminaireRow> luminaires{};
  std::vector<CalculationSurface> surfaces{};
  std::vector<Observer> observers{};
};

/// Power density of a working plane. Empty unless
/// - the surface is a plane above a surface (height above 0),
/// - the power of every luminaire is known, and
/// - the mean illuminance is above 0.
std::optional<PowerDensity> power_density(const LightingReport& report,
                                          const CalculationSurface& surface);

/// The report as one HTML page without external files, for screen and print. `range` is the scale
/// of the false colours of every plan; unset, each plan has a scale of its own.
std::string lighting_page(const LightingReport& report, const std::optional<LuxRange>& range);

}  // namespace lightwell
