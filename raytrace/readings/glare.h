#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "mesh/elements/element_caster.h"
#include "radiosity/direct_light/direct_light.h"
#include "radiosity/gather/final_gather.h"
#include "radiosity/solution/solution.h"
#include "scene/scene.h"

namespace lightwell {

struct FreeSource;

/// Guth's position index p >= 1 of a source in a direction `sigma` degrees from the line of sight,
/// [0, 90), and `tau` degrees from straight up around the line of sight, [0, 180]. Above the line
/// of sight (tau <= 90) after Levin 1975, the formula of the table in CIE 117:
///
///     ln p = (35.2 - 0.31889 tau - 1.22 exp(-2 tau / 9)) 1e-3 sigma
///            + (21 + 0.26667 tau - 0.002963 tau^2) 1e-5 sigma^2
///
/// Below the line of sight, where CIE 117 has no values, after Iwata & Tokura 1997: p = 1 + 0.8 r
/// for r = tan sigma below 0.6, else 1 + 1.2 r.
double position_index(double sigma, double tau);

/// Position index of a unit vector from an eye, within 90 degrees of the eye's direction.
double position_index(const Camera& eye, const Eigen::Vector3d& towards);

/// Returns whether a point counts for glare, by its distances along the line of sight, beside it
/// and above it. The table of CIE 117 ends at 3 times the distance along the line of sight to the
/// sides, and at 1.9 times above.
bool counts_for_glare(double ahead, double beside, double above);

/// Glare of one luminaire, or of all luminaires of one name.
struct GlareSource {
  std::string name{};
  double solid_angle = 0.0;     ///< sr, of the visible part
  double luminance = 0.0;       ///< cd/m^2, mean over solid_angle
  double position_index = 0.0;  ///< sqrt(luminance^2 solid_angle / share)
  double share = 0.0;           ///< int L^2 / p^2 dw, cd^2 / m^4 sr
};

struct Glare {
  /// Unified glare rating, 8 log10(0.25 / L_b sum L^2 w / p^2) (CIE 117-1995), at least 0. Empty if
  /// no luminaire is in sight or the background is black.
  std::optional<double> ugr{};
  double background = 0.0;  ///< L_b = E_i / pi, cd/m^2
  /// Luminaires in sight, surfaces first, in the order of the scene.
  std::vector<GlareSource> sources{};
  /// Lamps without a luminous area, for which UGR is undefined.
  std::vector<std::string> left_out{};
};

/// Light that comes straight from a luminaire, or from a part of one.
struct ArrivingLight {
  Eigen::Vector3d direction = Eigen::Vector3d::UnitZ();  ///< unit, towards the luminaire
  double lux = 0.0;                                      ///< across the direction, lx
};

/// GlareSource::share of one lamp with an opening for an eye, as unified_glare_rating() has it: 0
/// for a lamp that is out of sight or has no luminous area. `lamp` is a source with a LampLight,
/// `luminous_height` that of its sides, m.
double glare_share(const Bands& bands, const ElementCaster& caster, const FreeSource& lamp,
                   const Camera& eye, double luminous_height);

/// Unified glare rating for an eye at the camera's position that looks along its direction.
///
/// - Sources within counts_for_glare(): surfaces that emit, and lamps with an opening, with the
///   light of the solution. Sky and sun are no luminaires. Luminaires seen through glass or in
///   mirrors are left out.
/// - Background: E_i is the illuminance of the eye by reflected light alone, from a final gather
///   with `gathering`.
/// - `luminous_heights`, m: per lamp of the scene, the height of luminous sides around its opening;
///   empty: no sides. Sides are treated as if they stood at the opening.
Glare unified_glare_rating(const Scene& scene, const ElementCaster& caster,
                           const DirectLight& direct_light, const RadiositySolution& solution,
                           const Camera& eye, const GatherOptions& gathering,
                           std::span<const double> luminous_heights = {});

}  // namespace lightwell
