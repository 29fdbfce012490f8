#pragma once

#include <string>
#include <vector>

#include "scene/scene.h"

namespace lightwell {

/// Questions about a scene that is probably not what its author meant, one sentence each: a room of
/// kilometres (millimetres read as metres), and lamps far outside of all surfaces. The scene stays
/// as it is.
std::vector<std::string> scene_hints(const Scene& scene);

}  // namespace lightwell
