#include "scene/io/directional_light.h"

namespace lightwell {

void add_directional_light(const Eigen::Vector3d& towards, const Spectrum& irradiance,
                           const std::string& name, Scene& scene, Remarks& remarks) {
  if (!scene.sky) scene.sky = dark_sky(scene.bands);
  if (scene.sky->sun) {
    remarks.add("A scene has one sun here; further directional lights were left out", name);
    return;
  }
  remarks.add("Directional lights became a sun, a disc 0.53 degrees across", name);
  scene.sky->sun = Sun{.direction = towards.stableNormalized(), .irradiance = irradiance};
}

}  // namespace lightwell
