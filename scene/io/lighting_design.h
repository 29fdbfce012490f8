#pragma once

#include <Eigen/Geometry>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "scene/grid_quantity.h"
#include "scene/scene.h"

namespace lightwell {

struct LuminaireFile;
using SharedLuminaireFile = std::shared_ptr<const LuminaireFile>;

/// Heading of a report (the [report] table): text for people, each empty unless given.
struct ReportHeading {
  std::string project{}, client{}, author{}, date{}, remarks{};
};

/// A plane over a surface of a scene on which illuminance is calculated (a [[grids]] table).
struct CalculationGrid {
  std::string name{};
  int surface = 0;                 ///< index into Scene::surfaces
  double height = 0.0;             ///< m above the surface, >= 0
  std::optional<double> margin{};  ///< m, width of the outline strip without points; empty: usual
  double spacing = 0.0;            ///< m between points, at most; 0: the usual spacing
  /// Box, m, whose rectangle on the surface is the part that counts; empty: all of the surface.
  std::optional<Eigen::AlignedBox3d> part{};
  /// Corners of a polygon and of its holes, m, that stand in place of the surface's outline.
  std::vector<std::vector<Eigen::Vector3d>> outline{};
  std::vector<int> leaves_out{};  ///< earlier grids, over which there are no points
  GridQuantity quantity = GridQuantity::planar;
  Eigen::Vector3d facing = Eigen::Vector3d::UnitX();  ///< of vertical and semicylindrical
};

/// Kinds of areas that EN 1838 lights in an emergency.
enum class EmergencyArea {
  escape_route,        ///< at most 2 m wide
  open_area,           ///< of more than 60 m^2, in which people could panic
  high_risk_task_area  ///< where a dangerous process must be brought to an end
};

/// Limits of illuminance towards cameras; 0: none.
struct TelevisionLimits {
  double mean = 0.0;        ///< least E_v,m, lx
  double uniformity = 0.0;  ///< least E_v,min / E_v,m
  double contrast = 0.0;    ///< least E_v,min / E_v,max
  double gradient = 0.0;    ///< greatest change between neighbouring points, percent
};

/// An area's sport, and the cameras that look at it (keys of an [[areas]] table).
struct SportUse {
  std::string sport{};                 ///< key of a sport
  int number = 1;                      ///< of its class: 1, 2 or 3
  double reflectance = 0.2;            ///< of the ground, for glare ratings
  std::vector<std::string> cameras{};  ///< of television
  double camera_height = 1.0;          ///< m above the grid, of the points for cameras
  TelevisionLimits television{};
};

/// An area that is held to the limits of a standard (an [[areas]] table): to those of EN 12464-1
/// for an activity, of EN 1838 in an emergency, or of EN 12193 for a sport.
struct DesignArea {
  std::string name{};
  std::string activity{};                       ///< key of an activity; empty for others
  bool is_raised = false;                       ///< held to the activity's raised illuminance
  std::optional<EmergencyArea> emergency{};     ///< empty for an activity or a sport
  std::optional<SportUse> sport{};              ///< empty for an activity, and in an emergency
  double usual_lux = 0.0;                       ///< lx without emergency, of a high-risk task area
  int grid = 0;                                 ///< index into LightingDesign::grids
  std::optional<int> surround{}, background{};  ///< likewise
  std::vector<int> walls{}, ceilings{};         ///< indices into Scene::surfaces
  std::vector<std::string> observers{};         ///< cameras for whose eyes glare is rated
  double eye_height = 1.2;  ///< m above the grid's surface, of cylindrical illuminance
};

/// Parts of a maintenance factor, each in (0,1] (CIE 97:2005).
struct MaintenanceParts {
  double lamp_flux = 1.0, lamp_survival = 1.0, luminaire = 1.0, room = 1.0;

  double factor() const { return lamp_flux * lamp_survival * luminaire * room; }
};

/// Hours and shares of use of electric light in a year (the [energy] table; EN 15193-1).
struct LightingUse {
  int surface = 0;  ///< index into Scene::surfaces, whose area the energy is related to
  double daylight_hours = 0.0, night_hours = 0.0;     ///< h
  double daylight = 1.0, occupancy = 1.0;             ///< shares, [0,1]
  bool is_constant_illuminance = false;               ///< true: new lamps are dimmed
  double standby_watts = 0.0;                         ///< of controls, W
  double charging_watts = 0.0, charging_hours = 0.0;  ///< of emergency luminaires, W and h
};

/// The part of a scene file that describes the lighting design. A LightingDesign changes no
/// solution.
struct LightingDesign {
  std::vector<CalculationGrid> grids{};
  std::vector<DesignArea> areas{};
  std::optional<MaintenanceParts> maintenance{};  ///< the [maintenance] table
  std::optional<LightingUse> use{};
  // Indexed like Scene::lamps; empty without lamps, or where the format holds no such data.
  std::vector<double> watts{};  ///< electric power; 0: unknown
  /// Height in m of the luminous sides in the lamp's photometric file.
  std::vector<double> luminous_height{};
  std::vector<SharedLuminaireFile> files{};  ///< photometric file; null: none
  ReportHeading heading{};
};

/// The maintenance factor of electric light: `given`, or that of the design, or 1.
inline double maintenance_factor(std::optional<double> given, const LightingDesign& design) {
  return given.value_or(design.maintenance.value_or(MaintenanceParts{}).factor());
}

/// Reads the design from the file of `scene`, as read_toml_lighting() or read_stf_lighting() does.
/// Empty for formats other than the native one and STF. Throws what read_scene() throws.
LightingDesign read_lighting_design(const Scene& scene);

/// The design in the native format: the tables [[grids]], [[areas]], [maintenance], [energy] and
/// [report], and the photometric files and electric power of the [[lamps]] tables. The power of a
/// lamp is its key `watts`, else the power in its photometric file. The photometric file's power is
/// ignored where the key `lumens` rescales the flux, since the lamp is another luminaire then.
LightingDesign read_toml_lighting(const Scene& scene);

/// The design in an STF file: a grid on the working plane of each room, the maintenance factor
/// that all rooms share, photometric files and loads of luminaires, and the heading.
LightingDesign read_stf_lighting(const Scene& scene);

/// Reads the tables [[grids]], [[areas]], [maintenance], [energy] and [report] of a TOML file
/// beside a scene of any format into `design`, in place of those that it holds. Throws InputError
/// naming file, line and remedy.
void read_design_tables(const std::filesystem::path& file, const Scene& scene,
                        LightingDesign& design);

}  // namespace lightwell
