#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "raytrace/readings/lux_grid.h"

namespace lightwell {

/// Figures that standards limit.
enum class Figure {
  mean,         ///< E_m, lx
  least,        ///< E_min, lx
  uniformity,   ///< U_0 = E_min / E_m
  diversity,    ///< E_max / E_min
  cylindrical,  ///< mean cylindrical illuminance E_m,z, lx
  modelling,    ///< cylindrical over horizontal illuminance of the same points
  glare,        ///< unified glare rating R_UG
  // Roads
  luminance,                ///< L_m of the road, cd/m^2
  overall_uniformity,       ///< U_o = L_min / L_m
  wet_uniformity,           ///< U_o of the wet road
  longitudinal_uniformity,  ///< U_l = L_min / L_max along the middle of a lane
  threshold_increment,      ///< f_TI, percent
  edge_ratio,               ///< R_EI, of illuminance beside the road to that within
  least_vertical,           ///< E_v,min, lx
  least_semicylindrical,    ///< E_sc,min, lx
  // Sports
  vertical_mean,        ///< E_v,m towards a camera, lx
  vertical_uniformity,  ///< E_v,min / E_v,m
  vertical_contrast,    ///< E_v,min / E_v,max
  gradient,             ///< greatest change of illuminance between neighbouring points, percent
  glare_rating,         ///< R_G of CIE 112
  // Colours
  colour_rendering  ///< R_a
};

/// Symbol of a figure: "E_m".
const char* figure_symbol(Figure figure);

/// Standing of a figure to its limit.
enum class Verdict {
  met,       ///< by more than the error of the figure
  missed,    ///< by more than the error of the figure
  too_close  ///< the limit lies within the error of the figure, or the error is not known
};

/// A limit of a standard, and the figure that is held to it.
struct Requirement {
  std::string area{};   ///< of the design
  std::string place{};  ///< that was measured: a grid, a wall, an observer
  Figure figure = Figure::mean;
  bool is_upper = false;        ///< true: the figure must not exceed the limit
  bool is_recommended = false;  ///< true: the standard advises, and does not require
  double limit = 0.0;
  /// Empty: there is nothing to rate, such as glare without luminaires. NaN: the figure is not
  /// defined for what is there.
  std::optional<double> value{};
  /// Bound of the error of `value`, with odds of about 19 to 1; NaN: unknown.
  double within = 0.0;
};

/// "met", "missed" or "too close to tell".
const char* verdict_name(Verdict standing);

/// Verdict on a requirement. A requirement without a value is met.
Verdict verdict_of(const Requirement& requirement);

/// Verdict on requirements together, recommendations left out: missed if one is missed, too close
/// if one is too close and none is missed.
Verdict verdict_of(std::span<const Requirement> requirements);

/// Runs of requirements that belong to one area, in their order.
std::vector<std::span<const Requirement>> by_area(std::span<const Requirement> requirements);

/// A field of a grid with the name of the grid.
struct GridField {
  std::string name{};
  const LuxField* field = nullptr;
};

/// Bound of the point of a field whose illuminance is nearest to `lux`, lx; 0 where no light was
/// found at all, so that nothing is known.
double known_bound(const LuxField& field, double lux);

/// A rating, or an index, of a name.
struct NamedRating {
  std::string name{};
  double value = 0.0;   ///< NaN: not defined
  double within = 0.0;  ///< bound of its error; NaN: unknown
};

/// Part over whole, and 0 of a whole that is not above 0.
double share(double part, double whole);

/// Adds the requirement for the colour rendering R_a of luminaires: that of the one whose R_a may
/// be the least, by value less bound. A luminaire without a known bound comes before all others.
/// Nothing if there is no luminaire, or the limit is 0.
void add_colour_rendering(double limit, const std::vector<NamedRating>& luminaires,
                          const std::string& area, std::vector<Requirement>& requirements);

/// Requirement for the mean of a field, and for the uniformity of a field. The bound of U_0 is the
/// sum of the relative bounds of E_min and E_m.
Requirement mean_at_least(double limit, const GridField& of);
Requirement uniformity_at_least(double limit, const GridField& of);
/// Requirement for the darkest point of a field.
Requirement least_at_least(double limit, const GridField& of);
/// Requirement for E_max / E_min of a field. The bound is the sum of the relative bounds of both.
Requirement diversity_at_most(double limit, const GridField& of);

}  // namespace lightwell
