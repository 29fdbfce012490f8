#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "radiosity/direct_light/direct_light.h"
#include "radiosity/many_lights/light_tree.h"
#include "scene/sampling.h"
#include "scene/scene.h"

namespace lightwell::test {

/// A number in [0,1) by two whole numbers.
inline double uniform(int k, int use) {
  return random_uniform(random_key(static_cast<std::uint64_t>(k), static_cast<std::uint64_t>(use)));
}

inline Eigen::Vector3d unit_direction(int k, int use) {
  const double z = 2.0 * uniform(k, use) - 1.0, phi = 2.0 * std::numbers::pi * uniform(k, use + 1);
  const double r = std::sqrt(1.0 - z * z);
  return {r * std::cos(phi), r * std::sin(phi), z};
}

/// A place of lamps in a hall of 20 x 20 x 6 m.
inline Eigen::Vector3d place_of_lamp(int k, int use) {
  return {-9.5 + 19.0 * uniform(k, use), -9.5 + 19.0 * uniform(k, use + 1),
          4.2 + 1.5 * uniform(k, use + 2)};
}

/// Lamp `k` of the hall: a spot, a lamp with an opening, or an even one.
inline Lamp random_lamp(int k, const Bands& bands) {
  Lamp lamp{
      .name = "lamp" + std::to_string(k),
      .position = place_of_lamp(k, 12),
      .axes = lamp_axes(unit_direction(k, 15)),
      .intensity = constant_spectrum(bands, 1.0f + 9.0f * static_cast<float>(uniform(k, 17)))};
  if (k % 3 == 0) lamp.shape = SpotCone{.inner = 0.2, .outer = 0.3 + uniform(k, 18)};
  if (k % 3 == 1) lamp.opening = {.along_c0 = 0.6 * uniform(k, 19), .along_c90 = 0.1};
  return lamp;
}

/// The unobstructed irradiance of each light at a point, mean of the bands, W/m^2.
inline std::vector<double> unoccluded(const DirectLight& light, const SurfacePoint& at) {
  std::vector<double> E;
  for (const Emitter& emitter : light.emitters()) {
    E.push_back(light.unoccluded_form_factor(emitter, at) * emitter.exitance.mean());
  }
  for (const FreeSource& source : light.free_sources()) {
    E.push_back(unoccluded_kernel(source, at.position, at.normal) *
                light_towards(source, at.position).mean());
  }
  return E;
}

/// One tree of all emitters and lamps.
inline LightTree tree_of(const DirectLight& light) {
  std::vector<LightBound> bounds = bounds_of(light.emitters());
  const auto of_lamps = bounds_of(light.free_sources(), static_cast<int>(light.emitters().size()));
  bounds.insert(bounds.end(), of_lamps.begin(), of_lamps.end());
  return LightTree(std::move(bounds));
}

}  // namespace lightwell::test
