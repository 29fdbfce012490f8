#pragma once

#include <Eigen/Core>
#include <span>
#include <string>
#include <vector>

#include "daylight/annual_metrics.h"
#include "daylight/daylight_model.h"
#include "daylight/sky_year.h"
#include "scene/camera.h"

namespace lightwell {

/// Daylight glare probability (Wienold & Christoffersen 2006),
///
///     DGP = 5.87e-5 E_v + 9.18e-2 log10(1 + sum L^2 w / (E_v^1.87 P^2)) + 0.16
///
/// of the vertical illuminance E_v at the eye, lx, and the sum of L^2 w / P^2 over the glare
/// sources, cd^2/m^4 sr. In [0, 1]; 0 in the dark. Fitted to values from 0.2 to 0.8.
double daylight_glare_probability(double vertical_lux, double contrast);

/// The simplified DGPs = 6.22e-5 E_v + 0.184 (Wienold 2009), for eyes that see no sun. In [0, 1]; 0
/// in the dark.
double simplified_glare_probability(double vertical_lux);

/// Sky patches and ground that an eye sees, straight and through clear panes.
struct GlareView {
  Eigen::ArrayXf transmittance{};  ///< per column of the sky: mean over its visible part
  Eigen::ArrayXf weight{};         ///< int T^2 / P^2 dw over the visible part of each column, sr
};

/// Least luminance of a patch that is a glare source, cd/m^2.
inline constexpr float glare_luminance = 2000.0f;

/// Greatest position index P of a glare source, as evalglare has it (Wienold & Christoffersen
/// 2006). The formulas of position_index() grow far beyond it towards the edge of the field of
/// view.
inline constexpr double most_position_index = 16.0;

/// The view of an eye by `rays` x `rays` rays through each cell of the sky. Position index P: see
/// position_index(), at most most_position_index.
GlareView glare_view(const DaylightModel& model, const Camera& eye, int rays = 3);

/// Sum of L^2 w / P^2, cd^2/m^4 sr, over sky and ground that an eye sees brighter than
/// glare_luminance, for each hour.
Eigen::ArrayXd sky_contrast(const DaylightModel& model, const GlareView& view,
                            std::span<const SkyHour> hours, double ground_reflectance);

/// The same of the sun, for sunlight at the eye, lx across its direction of view. The sun's disc
/// has the luminance that gives that illuminance, but at most that of the hour's sun in the open.
double sun_contrast(const Camera& eye, const SkyHour& hour, double sunlight);

/// Glare of an eye over the occupied hours of a year.
struct GlareOfYear {
  std::string name{};
  /// Shares of the occupied hours, %, with a DGP above 0.35, 0.40 and 0.45.
  double above_35 = 0.0, above_40 = 0.0, above_45 = 0.0;
  /// The same of the simplified DGPs, hours with sun at the eye included.
  double simplified_above_35 = 0.0, simplified_above_40 = 0.0, simplified_above_45 = 0.0;
  /// EN 17037, table A.5: "high", "medium", "minimum" or "none": in at most 5 % of the hours is the
  /// DGP above 0.35, 0.40 or 0.45.
  std::string level{};
  std::vector<float> dgp{};           ///< of each hour with light
  std::vector<float> vertical_lux{};  ///< of each hour with light
};

/// Counts the hours of `glare`, whose `dgp` and `vertical_lux` are those of `hours`.
/// `occupied_hours` is their number in the year, nights included.
void count_glare(std::span<const SkyHour> hours, const Occupancy& occupancy, int occupied_hours,
                 GlareOfYear& glare);

}  // namespace lightwell
