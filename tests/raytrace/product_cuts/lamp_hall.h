#pragma once

#include <vector>

#include "raytrace/product_cuts/pixel_point.h"
#include "tests/radiosity/many_lights/random_lamps.h"
#include "tests/raytrace/lit_scene.h"

namespace lightwell::test {

/// A hall of 20 x 20 x 6 m with screens under `panels` that face everywhere and `lamps`: spots,
/// lamps with openings and even ones.
inline Scene lamp_hall(int panels, int lamps) {
  SceneBuilder builder;
  builder.box({.reflectance = 0.5f}, {-10, -10, 0}, {10, 10, 6}, true);
  for (int k = 0; k < 6; ++k) {
    const double x = -8.0 + 3.0 * k;
    builder.box({.reflectance = 0.3f}, {x, -4, 1}, {x + 0.2, 4, 4}, false);
  }
  for (int k = 0; k < panels; ++k) {
    builder.square({.exitance = 1.0f + 9.0f * static_cast<float>(uniform(k, 1))},
                   place_of_lamp(k, 2), unit_direction(k, 5), 0.02 + 0.1 * uniform(k, 7));
  }
  Scene scene = builder.build();
  for (int k = 0; k < lamps; ++k) {
    scene.lamps.push_back(random_lamp(k, scene.bands));
  }
  return scene;
}

/// Points in the air of lamp_hall() about the place `cluster`, `spread` m apart, that face about
/// the same direction.
inline std::vector<PixelPoint> points_about(const TracedScene& lit, int cluster, int count,
                                            double spread) {
  const Eigen::Vector3d middle(-8.0 + 16.0 * uniform(cluster, 30),
                               -8.0 + 16.0 * uniform(cluster, 31),
                               0.8 + 3.0 * uniform(cluster, 32));
  const Eigen::Vector3d normal = unit_direction(cluster, 33);
  std::vector<PixelPoint> points;
  for (int i = 0; i < count; ++i) {
    const int k = 1000 * (cluster + 1) + i;
    const Eigen::Vector3d bent = normal + 0.3 * uniform(k, 35) * unit_direction(k, 36);
    points.push_back(
        {.at = {middle + spread * uniform(k, 38) * unit_direction(k, 39), bent.normalized(), -1},
         .weight = Spectrum::Constant(3, 0.1f + static_cast<float>(uniform(k, 41))),
         .caster = &lit.caster});
  }
  return points;
}

/// Irradiance without occluders of each light (rows) at each point, mean of the bands, W/m^2.
inline Eigen::ArrayXXd unoccluded(const DirectLight& light, const std::vector<PixelPoint>& points) {
  Eigen::ArrayXXd E(light.light_count(), static_cast<Eigen::Index>(points.size()));
  for (Eigen::Index p = 0; p < E.cols(); ++p) {
    const std::vector<double> at_point = unoccluded(light, points[static_cast<std::size_t>(p)].at);
    E.col(p) = Eigen::Map<const Eigen::ArrayXd>(at_point.data(), E.rows());
  }
  return E;
}

}  // namespace lightwell::test
