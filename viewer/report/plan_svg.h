#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>

#include "viewer/export/false_color.h"
#include "viewer/report/lighting_report.h"
#include "viewer/report/words.h"

namespace lightwell {

/// Contents of a plan.
struct PlanContents {
  const CalculationSurface& surface;
  const LuxField& field;
  LuxRange range{};
  int number = 0;  ///< different for the plans of one page
  /// Unit vector to the north along u and v; empty: none in the plane, or the scene has no sky.
  std::optional<Eigen::Vector2d> north{};
  double metres_per_unit = 1.0;
  std::string unit_name = "m";
  std::string unit = "lx";  ///< of the field's values
  Language language = Language::english;
};

/// Scale of a plan's false colours, fitted to its values: round ends, linear if the greatest
/// illuminance is at most 20 times the least, since a linear scale is easier to read; lux_range()
/// otherwise.
LuxRange plan_range(const LuxField& field);

/// The number N of the scale 1 : N at which a plan fits on A4 paper.
int plan_scale(const PlanLines& lines);

/// A plan as SVG, v upwards, in millimetres of paper at the scale of plan_scale(): illuminance in
/// false colours with its values and isolux lines, walls, panes, furniture, luminaires, observers,
/// axes, a bar of the scale, and the north.
std::string plan_svg(const PlanContents& plan);

/// North along u and v of a grid that lies level; empty: `north` is not known, or the grid
/// inclines.
std::optional<Eigen::Vector2d> north_in(const std::optional<Eigen::Vector3d>& north,
                                        const LuxGrid& grid);

/// Luminous intensity of a luminaire in the planes C0 to C180 (solid) and C90 to C270 (dashed), cd
/// for each 1000 lm, as a polar curve in SVG.
std::string polar_svg(const LuminaireFile& luminaire, Language language = Language::english);

/// Illuminance with digits that suit its size: "523", "52.3", "5.23".
std::string lux_text(double lux);

}  // namespace lightwell
