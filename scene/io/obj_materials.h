#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "scene/scene.h"

namespace lightwell {

/// The materials of an MTL file (RGB bands), read as docs/scene-format.md says. What had to be left
/// out or changed is added to `notes`. Throws InputError naming file, line, value and remedy.
std::vector<Material> read_obj_materials(const std::filesystem::path& path,
                                         std::vector<std::string>& notes);

/// Diffuse, reflectance 0.5 in all of `bands`: for geometry that names no material.
Material default_material(const Bands& bands);

}  // namespace lightwell
