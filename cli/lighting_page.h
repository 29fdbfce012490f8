#pragma once

#include <optional>
#include <string>
#include <vector>

#include "raytrace/glare.h"
#include "raytrace/lux_grid.h"
#include "viewer/appearance.h"

namespace lightwell {

/// A line of the list of luminaires: all emitters of one name.
struct LuminaireRow {
  std::string name{};
  int count = 0;       ///< surfaces or lamps
  double flux = 0.0;   ///< lm, of all of them, as bright as they are in the solution
  double watts = 0.0;  ///< electric power, of all of them; 0: unknown
};

struct CalculationSurface {
  LuxGrid grid{};
  LuxField field{};
};

struct Observer {
  std::string name{};
  Glare glare{};
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

/// One page to read and to print, which holds all it needs. Plans are in false colours; `range`:
/// theirs, else what suits each.
std::string lighting_page(const LightingReport& report, const std::optional<LuxRange>& range);

}  // namespace lightwell
