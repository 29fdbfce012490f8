#pragma once

#include <Eigen/Core>
#include <functional>
#include <vector>

#include "scene/scene.h"
#include "scene/surface_point.h"

namespace lightwell {

/// One of the 15 standard skies of ISO 15469, or 16: the overcast sky of Moon & Spencer. One band's
/// radiance is 1 times the relative luminance; no sun, z upwards, black ground.
Sky numbered_sky(int number, const Eigen::Vector3d& to_sun);

/// A rectangle between outside and inside: `origin`, `origin` + u, ...
struct Opening {
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();
  Eigen::Vector3d u = Eigen::Vector3d::UnitX(), v = Eigen::Vector3d::UnitY();
  std::vector<Eigen::Vector3d> corners() const {
    return {origin, origin + u, origin + u + v, origin + v};
  }
  Eigen::Vector3d normal() const;
};

/// A pane of clear glass, by Fresnel's equations with all reflections between its faces.
struct ClearPane {
  double index = 1.52;
  double transmissivity = 1.0;  ///< of the body along the normal
};

/// A pane of 6 mm clear glass with the normal transmittance `T`: that of the body follows from the
/// reflectance r of a face, T = (1 - r)^2 t / (1 - r^2 t^2).
ClearPane pane_of_transmittance(double T);

/// Transmittance of unpolarised light, written out here so that it shares no code with the program.
double pane_transmittance(const ClearPane& pane, double cosine);

/// Irradiance over a dome through an opening, W/m^2, by Gauss's rule over the opening:
/// int L T cos cos / r^2 dA. `transmittance` is asked for the cosine at the opening. Relative error
/// about 1e-4 for points a quarter of the opening's size or more away.
double light_through(const Opening& opening, const Sky& sky, const SurfacePoint& at,
                     const std::function<double(double cosine)>& transmittance);

/// A material that lets light pass as the pane does.
Material pane_material(const Bands& bands, const ClearPane& pane);

}  // namespace lightwell
