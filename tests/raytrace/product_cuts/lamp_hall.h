#pragma once

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "radiosity/emitters/free_source.h"
#include "radiosity/many_lights/light_tree.h"
#include "raytrace/product_cuts/pixel_point.h"
#include "scene/sampling.h"
#include "tests/raytrace/lit_scene.h"

namespace lightwell::test {

inline double uniform(int k, int use) {
  return random_uniform(random_key(static_cast<std::uint64_t>(k), static_cast<std::uint64_t>(use)));
}

inline Eigen::Vector3d unit_direction(int k, int use) {
  const double z = 2.0 * uniform(k, use) - 1.0, phi = 2.0 * std::numbers::pi * uniform(k, use + 1);
  const double r = std::sqrt(1.0 - z * z);
  return {r * std::cos(phi), r * std::sin(phi), z};
}

/// A hall of 20 x 20 x 6 m with screens under `panels` that face everywhere and `lamps`: spots,
/// lamps with openings and even ones.
inline Scene lamp_hall(int panels, int lamps) {
  SceneBuilder builder;
  builder.box({.reflectance = 0.5f}, {-10, -10, 0}, {10, 10, 6}, true);
  for (int k = 0; k < 6; ++k) {
    const double x = -8.0 + 3.0 * k;
    builder.box({.reflectance = 0.3f}, {x, -4, 1}, {x + 0.2, 4, 4}, false);
  }
  const auto place = [](int k, int use) {
    return Eigen::Vector3d(-9.5 + 19.0 * uniform(k, use), -9.5 + 19.0 * uniform(k, use + 1),
                           4.2 + 1.5 * uniform(k, use + 2));
  };
  for (int k = 0; k < panels; ++k) {
    builder.square({.exitance = 1.0f + 9.0f * static_cast<float>(uniform(k, 1))}, place(k, 2),
                   unit_direction(k, 5), 0.02 + 0.1 * uniform(k, 7));
  }
  Scene scene = builder.build();
  for (int k = 0; k < lamps; ++k) {
    Lamp lamp{.name = "lamp" + std::to_string(k),
              .position = place(k, 12),
              .axes = lamp_axes(unit_direction(k, 15)),
              .intensity =
                  constant_spectrum(scene.bands, 1.0f + 9.0f * static_cast<float>(uniform(k, 17)))};
    if (k % 3 == 0) lamp.shape = SpotCone{.inner = 0.2, .outer = 0.3 + uniform(k, 18)};
    if (k % 3 == 1) lamp.opening = {.along_c0 = 0.6 * uniform(k, 19), .along_c90 = 0.1};
    scene.lamps.push_back(lamp);
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
    const SurfacePoint& at = points[static_cast<std::size_t>(p)].at;
    Eigen::Index row = 0;
    for (const Emitter& emitter : light.emitters()) {
      E(row++, p) = light.unoccluded_form_factor(emitter, at) * emitter.exitance.mean();
    }
    for (const FreeSource& source : light.free_sources()) {
      E(row++, p) = unoccluded_kernel(source, at.position, at.normal) *
                    light_towards(source, at.position).mean();
    }
  }
  return E;
}

inline LightTree tree_of(const DirectLight& light) {
  std::vector<LightBound> bounds = bounds_of(light.emitters());
  const auto of_lamps = bounds_of(light.free_sources(), static_cast<int>(light.emitters().size()));
  bounds.insert(bounds.end(), of_lamps.begin(), of_lamps.end());
  return LightTree(std::move(bounds));
}

}  // namespace lightwell::test
