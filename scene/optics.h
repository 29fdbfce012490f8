#pragma once

#include <Eigen/Core>
#include <optional>

namespace lightwell {

/// Unpolarised Fresnel reflectance of a dielectric boundary, [0,1]. `cos_incident` is measured from
/// the normal, [0,1]; `relative_index` = n_transmitted / n_incident > 0. 1 under total internal
/// reflection. Born & Wolf, Principles of Optics, section 1.5.
double fresnel_reflectance(double cos_incident, double relative_index);

/// Mirror direction of `direction` (unit, towards the surface) about the unit normal.
Eigen::Vector3d reflect(const Eigen::Vector3d& direction, const Eigen::Vector3d& normal);

/// Snell's refraction of `direction` (unit, towards the surface; the unit normal points to the side
/// it comes from); empty under total internal reflection.
std::optional<Eigen::Vector3d> refract(const Eigen::Vector3d& direction,
                                       const Eigen::Vector3d& normal, double relative_index);

}  // namespace lightwell
