#pragma once

#include <optional>
#include <string>
#include <vector>

#include "raytrace/readings/glare.h"
#include "raytrace/readings/lux_grid.h"
#include "scene/io/lighting_design.h"
#include "scene/io/luminaires/luminaire_file.h"
#include "standards/colour_fidelity.h"
#include "standards/eye_light.h"
#include "standards/requirement.h"
#include "viewer/report/plan_lines.h"

namespace lightwell {

/// A line of the schedule of luminaires: all emitters of one name.
struct LuminaireRow {
  std::string name{};
  int count = 0;       ///< surfaces or lamps
  double flux = 0.0;   ///< lm, of all `count` emitters, with the solution's channel scales
  double watts = 0.0;  ///< installed electric power of all `count` emitters, W; 0: unknown
  /// R_a of the light of all; NaN where R_a is not defined, empty without wavelengths.
  std::optional<RatedColour> colour{};
  /// The photometric file; null: none, or not the same for all lamps of the name.
  SharedLuminaireFile file{};
};

/// Light that the figures of a report contain.
enum class LightContent {
  electric,  ///< the scene has no daylight, or daylight is switched off
  daylight,  ///< there is no electric light
  apart,     ///< both, and each measured by itself
  together   ///< both, which the solution does not keep apart
};

/// Illuminance on a grid of points.
struct CalculationSurface {
  LuxGrid grid{};
  /// All light. Electric light is maintained: the initial one times the maintenance factor.
  LuxField field{};
  /// The two parts of `field`, if LightContent::apart: maintained electric light, and daylight.
  std::optional<LuxField> electric{}, daylight{};
  PlanLines lines{};  ///< of the room and of what stands in it, for the plan
};

/// Glare and light for a camera's eye.
struct Observer {
  std::string name{};
  Camera eye{};
  Glare glare{};
  /// Illuminance of the plane across the line of sight, of all light, lx, and a bound of its error
  /// with odds of about 19 to 1; NaN: not known.
  double lux = 0.0, lux_within = 0.0;
  std::optional<EyeLight> light{};  ///< of the same plane; empty without wavelengths or light
  std::optional<ColourFidelity> fidelity{};  ///< R_f and R_g, if samples of colours are given
  /// Light of new luminaires at the eye, if a glare rating R_G is asked for.
  std::vector<ArrivingLight> arriving{};
};

/// Installed power of all luminaires over the area of a working plane, in the two units of EN
/// 15193: W/m^2, and W/m^2 for each 100 lx of maintained illuminance by electric light.
struct PowerDensity {
  double watts_per_area = 0.0;              ///< W/m^2
  std::optional<double> per_hundred_lux{};  ///< W/m^2 for each 100 lx of E_m; empty: not known
};

/// Energy of electric light in a year over the area of a surface (EN 15193-1).
struct LightingEnergy {
  std::string surface{};
  double area = 0.0;       ///< m^2
  double indicator = 0.0;  ///< LENI, kWh/m^2
};

/// A picture of the scene.
struct ReportPicture {
  std::string camera{};
  int width = 0, height = 0;
  std::string png{};  ///< bytes of a PNG file
};

/// Contents of a lighting report.
struct LightingReport {
  std::string title{};
  ReportHeading heading{};
  Provenance provenance{};
  double metres_per_unit = 1.0;
  std::string unit_name = "m";
  std::string sky{};                       ///< the sky's name; empty: no sky
  std::optional<Eigen::Vector3d> north{};  ///< unit; empty: not known
  LightContent content = LightContent::electric;
  double maintenance_factor = 1.0;
  int rays = 0;                 ///< gather rays per point
  double error_estimate = 0.0;  ///< of the solution, relative RMS; 0: unknown
  std::vector<LuminaireRow> luminaires{};
  std::vector<CalculationSurface> surfaces{};
  std::vector<Observer> observers{};
  /// Limits of standards, by areas of the design, and the figures that are held to them.
  std::vector<Requirement> requirements{};
  std::optional<LightingEnergy> energy{};  ///< empty: not asked for, or a power is not known
  std::optional<ReportPicture> picture{};
};

/// The field of electric light, where it is known by itself; null otherwise.
const LuxField* electric_field(const LightingReport& report, const CalculationSurface& surface);

/// Power density of a working plane. Empty unless
/// - the surface is a plane above a surface (height above 0) that was asked for, all of it, and
/// - the power of every luminaire is known.
std::optional<PowerDensity> power_density(const LightingReport& report,
                                          const CalculationSurface& surface);

}  // namespace lightwell
