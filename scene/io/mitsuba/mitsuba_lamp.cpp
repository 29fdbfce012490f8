#include "scene/io/mitsuba/mitsuba_lamp.h"

#include <fmt/format.h>

#include "scene/degree.h"
#include "scene/io/mitsuba/mitsuba_transform.h"

namespace lightwell {

bool add_mitsuba_lamp(const MitsubaNode& emitter, MitsubaColors& colors, Scene& scene) {
  if (emitter.type != "point" && emitter.type != "spot") return false;
  const Eigen::Affine3d to_world = read_to_world(emitter);
  Lamp lamp{.name = emitter.id.empty() ? fmt::format("lamp{}", scene.lamps.size() + 1) : emitter.id,
            .position = to_world.translation(),
            .intensity = colors.positive_or(emitter, "intensity", 1.0f)};
  if (emitter.type == "point") {
    if (const MitsubaNode* position = emitter.property("position")) {
      lamp.position = read_mitsuba_point(*position);
    }
    scene.lamps.push_back(std::move(lamp));
    return true;
  }
  const double cutoff = emitter.number_or("cutoff_angle", 20.0);
  const double beam = emitter.number_or("beam_width", 0.75 * cutoff);
  if (!(beam >= 0.0 && beam <= cutoff && cutoff > 0.0 && cutoff <= 180.0)) {
    emitter.fail(
        fmt::format("has a beam_width of {:g} and a cutoff_angle of {:g} degrees; it needs "
                    "0 <= beam_width <= cutoff_angle <= 180",
                    beam, cutoff));
  }
  lamp.shape =
      SpotCone{.inner = beam * degree, .outer = cutoff * degree, .edge = SpotCone::Edge::straight};
  const Eigen::Vector3d aim = to_world.linear() * Eigen::Vector3d::UnitZ();
  if (!(aim.stableNorm() > 0.0)) emitter.fail("has a transformation that leaves it no direction");
  lamp.axes = lamp_axes(aim.stableNormalized());
  scene.lamps.push_back(std::move(lamp));
  return true;
}

}  // namespace lightwell
