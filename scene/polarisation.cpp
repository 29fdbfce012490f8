#include "scene/polarisation.h"

#include <Eigen/Geometry>

#include "scene/optics.h"

namespace lightwell {

Polarisation about_plane_of_incidence(const Polarisation& light, const Eigen::Vector3d& direction,
                                      const Eigen::Vector3d& normal) {
  const bool is_polarised = light.q != 0.0 || light.u != 0.0;
  const Eigen::Vector3d across = direction.cross(normal);
  const double sine = across.norm();
  // Along the normal every axis is across the plane of incidence.
  constexpr double along_normal = 1e-9;
  if (!(sine > along_normal)) {
    return is_polarised ? light : Polarisation{.across = direction.unitOrthogonal()};
  }
  if (!is_polarised) return {.across = across / sine};
  const double c = across.dot(light.across), s = across.dot(direction.cross(light.across));
  const double norm = c * c + s * s;
  if (!(norm > 0.0)) return {.across = across / sine};
  const double cos_twice = (c * c - s * s) / norm, sin_twice = 2.0 * c * s / norm;
  return {.across = across / sine,
          .q = light.q * cos_twice + light.u * sin_twice,
          .u = light.u * cos_twice - light.q * sin_twice};
}

PolarisedLight after_interface(const Polarisation& before, const PolarisedShares& shares) {
  const double s = 0.5 * shares.s * (1.0 + before.q), p = 0.5 * shares.p * (1.0 - before.q);
  PolarisedLight after{.share = s + p, .polarisation = {.across = before.across}};
  if (!(after.share > 0.0)) return after;
  after.polarisation.q = (s - p) / after.share;
  after.polarisation.u = shares.u * before.u / after.share;
  return after;
}

}  // namespace lightwell
