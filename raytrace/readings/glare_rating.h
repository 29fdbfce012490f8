#pragma once

#include <Eigen/Core>
#include <vector>

#include "mesh/elements/element_caster.h"
#include "radiosity/direct_light/direct_light.h"
#include "raytrace/readings/glare.h"
#include "scene/scene.h"

namespace lightwell {

/// The light of all luminaires that a point sees: lamps, each from the middle of its opening, and
/// elements of surfaces that emit. Sky and sun are no luminaires; light through glass and by
/// mirrors is left out.
std::vector<ArrivingLight> arriving_light(const Scene& scene, const ElementCaster& caster,
                                          const DirectLight& direct_light,
                                          const Eigen::Vector3d& point);

/// Equivalent veiling luminance for an eye that looks along the unit vector `look`, cd/m^2 (CIE
/// 112-1994):
///
///     L_v = 10 sum E_eye / theta^2        E_eye across the line of sight, 1.5 < theta < 60 degrees
double veiling_luminance(const std::vector<ArrivingLight>& arriving, const Eigen::Vector3d& look);

/// Veiling luminance of an area of reflectance `rho` and mean horizontal illuminance `lux`, cd/m^2:
/// L_ve = 0.035 E_h,av rho / pi.
double environment_veil(double lux, double rho);

/// Glare rating R_G = 27 + 24 log10(L_vl / L_ve^0.9) of CIE 112-1994, at least 0.
double glare_rating(double luminaires_veil, double environment_veil);

/// The greatest rating of an eye that looks 2 degrees below the horizon all around, in steps of a
/// quarter of a degree. `up` is unit.
double greatest_glare_rating(const std::vector<ArrivingLight>& arriving, double environment_veil,
                             const Eigen::Vector3d& up);

/// Bound of the part of R_G that the steps of greatest_glare_rating() leave out, for luminaires
/// that are not below the eye and stay between the two angles of veiling_luminance(). The nearest
/// step is at most 0.125 degrees of azimuth off; theta is 2 degrees or more, so theta^2 grows by a
/// factor of (2^2 + 0.125^2) / 2^2 at most, and R_G falls by 24 log10(1.0039) = 0.041 at most. The
/// cosine of theta changes this by less than 0.001.
inline constexpr double glare_rating_step_within = 0.05;

}  // namespace lightwell
