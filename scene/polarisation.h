#pragma once

#include <Eigen/Core>

namespace lightwell {

struct PolarisedShares;

/// Linear polarisation of the light along a path: Stokes' parameters Q and U over I about the axis
/// `across`. U is positive for light polarised between `across` and direction x across. Sources
/// emit, and diffuse surfaces count, unpolarised light, so a path has the same shares from either
/// end.
struct Polarisation {
  /// Unit, at right angles to the direction of the light; zero for unpolarised light.
  Eigen::Vector3d across = Eigen::Vector3d::Zero();
  double q = 0.0, u = 0.0;  ///< q^2 + u^2 <= 1
};

/// The same polarisation about the axis that is normal to the plane of incidence. `direction` and
/// `normal` are unit vectors, of the light and of the surface.
Polarisation about_plane_of_incidence(const Polarisation& light, const Eigen::Vector3d& direction,
                                      const Eigen::Vector3d& normal);

/// Light that an interface leaves.
struct PolarisedLight {
  double share = 0.0;  ///< [0,1], of the light before
  Polarisation polarisation{};
};

/// Light of `before`, given about the plane of incidence, after the interface.
PolarisedLight after_interface(const Polarisation& before, const PolarisedShares& shares);

}  // namespace lightwell
