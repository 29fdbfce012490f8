#pragma once

#include <string>
#include <vector>

#include "scene/io/toml/toml_value.h"
#include "scene/scene.h"

namespace lightwell {

/// Adds what a [[surfaces]] table describes: one surface, or several for a mesh of several objects.
/// The scene's materials are there already; those of an OBJ file are added as they are needed.
void read_toml_surface(const TomlValue& value, std::size_t number, Scene& scene);

}  // namespace lightwell
