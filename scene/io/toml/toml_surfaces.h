#pragma once

#include <string>
#include <vector>

#include "scene/io/toml/toml_value.h"
#include "scene/scene.h"

namespace lightwell {

/// Adds the surface of a [[surfaces]] table, or several surfaces for a mesh of several objects. The
/// scene's materials must be complete; materials of an OBJ file are added at first use.
void read_toml_surface(const TomlValue& value, std::size_t number, Scene& scene);

}  // namespace lightwell
