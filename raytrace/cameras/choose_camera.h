#pragma once

#include <string>

#include "scene/scene.h"

namespace lightwell {

/// The scene's camera called `name`; the first camera if `name` is empty. Throws InputError that
/// lists the scene's cameras if none is called `name`, or if the scene has no camera.
const Camera& choose_camera(const Scene& scene, const std::string& name);

}  // namespace lightwell
