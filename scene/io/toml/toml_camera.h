#pragma once

#include <set>
#include <string>

#include "scene/io/toml/toml_value.h"
#include "scene/scene.h"

namespace lightwell {

/// Reads the camera of this number, counted from 1, of the scene. `names` are those of the cameras
/// before it, and gets its own.
Camera read_toml_camera(const TomlValue& value, std::size_t number, const Scene& scene,
                        std::set<std::string>& names);

}  // namespace lightwell
