#include "scene/io/gltf/gltf_light.h"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "scene/io/directional_light.h"

namespace lightwell {
namespace {

SpotCone read_gltf_cone(const JsonObject& light) {
  const auto spot = light.object("spot");
  if (!spot) light.fail("is a spot and lacks 'spot'");
  const SpotCone cone{.inner = spot->number_or("innerConeAngle", 0.0),
                      .outer = spot->number_or("outerConeAngle", 0.25 * std::numbers::pi)};
  if (!(cone.inner >= 0.0 && cone.inner < cone.outer && cone.outer <= 0.5 * std::numbers::pi)) {
    spot->fail(fmt::format("has a cone from {:g} to {:g}; 0 <= inner < outer <= pi/2", cone.inner,
                           cone.outer));
  }
  return cone;
}

}  // namespace

void add_gltf_light(const JsonObject& light, const JsonObject& node,
                    const Eigen::Affine3d& to_world, Scene& scene, Remarks& remarks) {
  const std::string type = light.string_or("type", "");
  const std::string name = node.has("name") ? node.name() : light.name();
  if (type != "point" && type != "spot" && type != "directional") {
    remarks.add(fmt::format("Lights of the type '{}' (KHR_lights_punctual) are not used", type),
                name);
    return;
  }
  Lamp lamp{.name = name, .position = to_world.translation()};
  const double intensity = light.number_or("intensity", 1.0);
  const auto color = light.numbers("color", 3);
  lamp.intensity = constant_spectrum(scene.bands, static_cast<float>(intensity));
  for (std::size_t k = 0; k < color.size(); ++k) {
    lamp.intensity[static_cast<Eigen::Index>(k)] *= static_cast<float>(color[k]);
  }
  if (!(lamp.intensity >= 0.0f).all() || !lamp.intensity.isFinite().all()) {
    light.fail("has an intensity or a color that is below 0, or too large");
  }
  if (type == "directional") {
    // A directional light shines along the -z of its node; its intensity is illuminance on a
    // perpendicular plane.
    const Eigen::Vector3d towards = to_world.linear() * Eigen::Vector3d::UnitZ();
    if (!(towards.stableNorm() > 0.0)) node.fail("leaves its light no direction");
    return add_directional_light(towards, lamp.intensity, name, scene, remarks);
  }
  if (type == "spot") {
    lamp.shape = read_gltf_cone(light);
    const Eigen::Vector3d aim = to_world.linear() * -Eigen::Vector3d::UnitZ();
    if (!(aim.stableNorm() > 0.0)) node.fail("leaves its light no direction");
    lamp.axes = lamp_axes(aim.stableNormalized());
  }
  if (light.has("range")) {
    remarks.add("Ranges of lights were passed over: light falls off with its distance alone", name);
  }
  scene.lamps.push_back(std::move(lamp));
}

}  // namespace lightwell
