#pragma once

#include <Eigen/Core>
#include <optional>

namespace lightwell {

/// Unpolarised Fresnel reflectance of a dielectric boundary, [0,1]. `cos_incident` is measured from
/// the normal, [0,1]; `relative_index` = n_transmitted / n_incident > 0. 1 under total internal
/// reflection. Born & Wolf, Principles of Optics, section 1.5.
double fresnel_reflectance(double cos_incident, double relative_index);

/// Fresnel reflectance of a smooth dielectric for even light from the whole hemisphere, 2 int
/// F(cos) cos dcos, [0,1]. `index` > 0 is relative to the side that the light comes from.
double diffuse_fresnel(double index);

/// Fresnel reflectances, [0,1], of light polarised across (s) and in (p) the plane of incidence;
/// arguments as for fresnel_reflectance().
struct PolarisedReflectance {
  double s = 0.0, p = 0.0;
};
PolarisedReflectance polarised_reflectance(double cos_incident, double relative_index);

/// Share of unpolarised light that a thin clear pane reflects, by both faces and all reflections
/// between them: 2 R / (1 + R), averaged over both polarisations. `index` is that of the pane,
/// relative to the medium on both sides. The rest passes.
double pane_reflectance(double cos_incident, double index);

/// Factors of light at an interface, by its linear polarisation: shares, [0,1], of light polarised
/// across (s) and in (p) the plane of incidence, and the factor, [-1,1], of Stokes' parameter U
/// about these two axes.
struct PolarisedShares {
  double s = 0.0, p = 0.0, u = 0.0;
};

/// Light that an interface sends back and lets pass.
struct InterfaceShares {
  PolarisedShares reflected, passed;
};

/// Both kinds of light at the face of a dielectric, by Fresnel's equations; arguments as for
/// fresnel_reflectance(). Under total internal reflection the phases of s and p differ, which turns
/// linear into elliptic polarisation; the circular part is left out.
InterfaceShares face_shares(double cos_incident, double relative_index);

/// Both kinds of light at a thin pane with all reflections between its faces. Light that crosses
/// the body along the normal keeps the share `transmissivity` t, [0,1], and refracted light d =
/// t^(1 / cos of the refracted angle). With the reflectance r of one face for s or p,
///
///     T = (1 - r)^2 d / (1 - r^2 d^2),   R = r (1 + d T);
///
/// `u` is the same sum of products of the amplitudes of s and p.
InterfaceShares pane_interface(double cos_incident, double index, double transmissivity);

/// Shares of light, [0,1], that a pane sends back and lets pass; the rest is absorbed.
struct PaneShares {
  double reflected = 0.0, passed = 0.0;
};

/// Shares of unpolarised light at a thin pane whose body absorbs: the mean of pane_interface() over
/// both polarisations. For t = 1 this is pane_reflectance().
PaneShares pane_shares(double cos_incident, double index, double transmissivity);

/// Mirror direction of `direction` (unit, towards the surface) about the unit normal.
Eigen::Vector3d reflect(const Eigen::Vector3d& direction, const Eigen::Vector3d& normal);

/// Returns the normal nearest `smooth` that mirrors light from `direction` to above the surface
/// (Keller et al. 2017, "The Iray light transport simulation and rendering system", appendix A.3).
/// `flat` is the surface's own unit normal, on the side that the light comes from. If `smooth`
/// itself mirrors the light to below, the result lies in the same plane and mirrors the light just
/// above the horizon.
Eigen::Vector3d visible_normal(const Eigen::Vector3d& direction, const Eigen::Vector3d& flat,
                               const Eigen::Vector3d& smooth);

/// Snell's refraction of `direction`, unit, towards the surface. The unit normal points to the side
/// that the light comes from. Empty under total internal reflection.
std::optional<Eigen::Vector3d> refract(const Eigen::Vector3d& direction,
                                       const Eigen::Vector3d& normal, double relative_index);

}  // namespace lightwell
