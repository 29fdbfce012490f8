#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <optional>
#include <string>
#include <vector>

#include "raytrace/readings/probe.h"
#include "scene/grid_quantity.h"
#include "scene/scene.h"

namespace lightwell {

/// Greatest spacing of a grid over `length` > 0 metres: p = 0.2 * 5^log10(length), at most 10 m (EN
/// 12464-1:2011, formula 2).
double greatest_grid_spacing(double length);

struct LuxGridOptions {
  double height = 0.0;   ///< m above the surface, along its normal
  double margin = 0.0;   ///< m, width of the strip along the outline without points, >= 0
  double spacing = 0.0;  ///< m, greatest distance between points; 0: that of EN 12464-1
  /// Part of the surface that the grid covers, m: the rectangle of a box, which may be flat. Its
  /// extent across the surface does not matter. Empty: all of the surface.
  std::optional<Eigen::AlignedBox3d> part{};
  /// Corners of a polygon, then of its holes, m, in place of the surface's outline. Heights above
  /// the surface do not matter. Empty: the surface's own.
  std::vector<std::vector<Eigen::Vector3d>> outline{};
  /// Point, m, that the grid's plane faces: with the front or the back of the surface. Empty: the
  /// front.
  std::optional<Eigen::Vector3d> towards{};
};

/// Points over a plane surface at which illuminance is measured: the centres of equal cells.
struct LuxGrid {
  std::string name{};
  int surface = 0;  ///< index into Scene::surfaces
  GridQuantity quantity = GridQuantity::planar;
  Eigen::Vector3d upright = Eigen::Vector3d::UnitZ();  ///< unit, axis of cylinders
  Eigen::Vector3d facing = Eigen::Vector3d::UnitX();   ///< unit, across `upright`
  bool is_direct_only = false;                         ///< true: reflected light does not count
  /// True: the grid was made for the limits of an area, beside those that were asked for.
  bool is_of_area = false;
  LuxGridOptions options{};                          ///< with the standard's spacing in place of 0
  Eigen::Vector3d corner = Eigen::Vector3d::Zero();  ///< m, outer corner of the first cell
  Eigen::Vector3d u = Eigen::Vector3d::UnitX(), v = Eigen::Vector3d::UnitY();  ///< unit, in plane
  double step_u = 0.0, step_v = 0.0;  ///< m, size of a cell
  int columns = 0, rows = 0;
  double area = 0.0;        ///< m^2, of the surface or the outline, margin included; or of the part
  std::vector<int> cell{};  ///< row * columns + column of each point, rising
  std::vector<Probe> points{};  ///< points inside the surface's outline less the margin
};

/// Returns the grid over a surface: over the largest set of its facets that lie in one plane. Of
/// two sets equal in area, the one that faces more towards `up` is taken. The axis u follows the
/// longest edge of the outline; of a plane that is not level, v points upwards and u is level.
///
/// The spacing follows from the longer side, or from the shorter side if their ratio exceeds 2:1
/// (EN 12464-1). Throws InputError if:
/// - the surface is a round shape;
/// - the margin or the part leaves nothing, or no point lies within the outline;
/// - a side would have more than 1000 points.
LuxGrid lux_grid(const Scene& scene, int surface, const Eigen::Vector3d& up,
                 const LuxGridOptions& options = {});

/// Returns the grid without buried points: points inside bodies or on their faces, such as points
/// of a working plane inside a cupboard. A point is buried if every ray of the plane's upper
/// hemisphere from the point, or from a point just beside it, meets the back of a surface. If all
/// points are buried, the scene's surfaces face away from its rooms, and the grid is returned as it
/// is.
LuxGrid without_buried_points(const ElementCaster& caster, LuxGrid grid);

/// Returns the grid without the points over the rectangle or outline of another one, such as the
/// surroundings of a task area without the task area.
LuxGrid without_points_over(const LuxGrid& other, LuxGrid grid);

/// Returns the grid without the points that surfaces hide from all points of `eyes`, or from 64 of
/// them, evenly spread, which bounds the time. If that leaves nothing, the grid is returned as it
/// is.
LuxGrid points_seen_from(const ElementCaster& caster, const LuxGrid& eyes, const LuxGrid& grid);

/// Makes a grid measure another quantity than planar illuminance. `up` and `facing` are unit
/// vectors; `facing` is made level, and matters to planes and half cylinders alone. Throws
/// InputError if `facing` is upright.
void measure_as(GridQuantity quantity, const Eigen::Vector3d& up, const Eigen::Vector3d& facing,
                LuxGrid& grid);

/// Illuminance over a grid, lx.
struct LuxField {
  Eigen::ArrayXd lux{};  ///< at each point
  Eigen::ArrayXd
      lux_within{};  ///< bound of its error (see ProbeBounds), NaN where nothing is known
  double mean = 0.0, least = 0.0, greatest = 0.0;
  double uniformity = 0.0;  ///< U_0 = least / mean; 0 without light
  /// Bounds with odds of about 19 to 1, relative: of one point, in the root mean square, and of the
  /// mean. The noise of the points is independent; the error of the solution's light is not.
  double point_within = 0.0, mean_within = 0.0;
};

/// The field of values at points whose bounds are not known (NaN). There is at least one point.
LuxField field_of(const Eigen::ArrayXd& lux);

/// Bound of the error of the point whose illuminance is nearest to `lux`, lx; NaN where nothing is
/// known. The field has at least one point.
double bound_at(const LuxField& field, double lux);

/// The sum of two kinds of light at the same points. Bounds add up: the errors of two gathers along
/// the same directions are not independent.
LuxField sum_of(const LuxField& a, const LuxField& b);

/// Illuminance at the points of a grid, times `factor` (for example a maintenance factor). The
/// gathers are those of probe_irradiance() with bounds; of a grid of cylinders, those of probes all
/// around each cylinder.
LuxField measure_grid(const Scene& scene, const ElementCaster& caster,
                      const DirectLight& direct_light, const RadiositySolution& solution,
                      const LuxGrid& grid, double factor, const GatherOptions& options);

}  // namespace lightwell
