#pragma once

#include <string>

#include "scene/scene.h"

namespace lightwell {

/// A name for the scene's next camera that no other has and that pictures can be called after:
/// `wanted`, its slashes replaced, or "camera1", "camera2" ...
std::string camera_name(std::string wanted, const Scene& scene);

}  // namespace lightwell
