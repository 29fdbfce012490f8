#pragma once

#include "scene/scene.h"

namespace lightwell {

/// Without surfaces yet; material 0 reflects half, from its front.
inline Scene grey_scene() {
  Scene scene;
  Material grey;
  grey.name = "grey";
  grey.reflectance = constant_spectrum(scene.bands, 0.5f);
  grey.specular = grey.emission = constant_spectrum(scene.bands, 0.0f);
  grey.one_sided = true;
  scene.materials = {grey};
  return scene;
}

}  // namespace lightwell
