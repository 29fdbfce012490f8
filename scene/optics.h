#pragma once

#include <Eigen/Core>
#include <optional>

namespace lightwell {

/// Unpolarised Fresnel reflectance of a dielectric boundary, [0,1]. `cos_incident` is measured from
/// the normal, [0,1]; `relative_index` = n_transmitted / n_incident > 0. 1 under total internal
/// reflection. Born & Wolf, Principles of Optics, section 1.5.
double fresnel_reflectance(double cos_incident, double relative_index);

/// The same for light polarised across (s) and in (p) the plane of incidence.
struct PolarisedReflectance {
  double s = 0.0, p = 0.0;
};
PolarisedReflectance polarised_reflectance(double cos_incident, double relative_index);

/// Share that a thin clear pane reflects of unpolarised light: both faces, and all reflections
/// between them, 2 R / (1 + R), the mean of both polarisations. `index` of the pane, relative to
/// what is on both sides of it. The rest passes.
double pane_reflectance(double cos_incident, double index);

/// Mirror direction of `direction` (unit, towards the surface) about the unit normal.
Eigen::Vector3d reflect(const Eigen::Vector3d& direction, const Eigen::Vector3d& normal);

/// The normal nearest `smooth` about which light from `direction` is mirrored above the surface,
/// whose own unit normal `flat` is on the side that the light comes from: `smooth` itself where
/// that does, else the one that mirrors it just above the horizon, in the same plane (Keller et al.
/// 2017, "The Iray light transport simulation and rendering system", appendix A.3).
Eigen::Vector3d visible_normal(const Eigen::Vector3d& direction, const Eigen::Vector3d& flat,
                               const Eigen::Vector3d& smooth);

/// Snell's refraction of `direction` (unit, towards the surface; the unit normal points to the side
/// it comes from); empty under total internal reflection.
std::optional<Eigen::Vector3d> refract(const Eigen::Vector3d& direction,
                                       const Eigen::Vector3d& normal, double relative_index);

}  // namespace lightwell
