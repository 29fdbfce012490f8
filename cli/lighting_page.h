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
  double flux = 0.0;   ///< lm, of all of them, as bright as they are in the solution
  double watts = 0.0;  ///< installed electric power, of all of them; 0: unknown
};

struct CalculationSurface {
  LuxGrid grid{};
  LuxField field{};
};

struct Observer {
  std::string name{};
  Glare glare{};
};

/// Installed power of all luminaires over the area of a working plane (EN 15193
/// have it as W/m^2 and, for each 100 lx of maintained illuminance, W/m^2/100 lx).
struct PowerDensity {
  double watts_per_area = 0.0;   ///< W/m^2
  double per_hundred_lux = 0.0;  ///< W/m^2 for each 100 lx of E_m
};

/// All that a report says.
struct LightingReport {
  std::string title{};
  Provenance provenance{};
  double metres_per_unit = 1.0;
  std::string unit_name = "m";
  double maintenance_factor = 1.0;
  int rays = 0;                 ///< of each point's gathers
  double error_estimate = 0.0;  ///< of the solution, relative; 0: unknown
  std::vector<LuminaireRow> luminaires{};
  std::vector<CalculationSurface> surfaces{};
  std::vector<Observer> observers{};
};

/// Of a plane above a surface, where the power of every luminaire is known and there is light.
std::optional<PowerDensity> power_density(const LightingReport& report,
                                          const CalculationSurface& surface);

/// One page to read and to print, which holds all it needs. Plans are in false colours; `range`:
/// theirs, else what suits each.
std::string lighting_page(const LightingReport& report, const std::optional<LuxRange>& range);

}  // namespace lightwell
