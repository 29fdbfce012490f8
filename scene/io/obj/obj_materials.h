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

}  // namespace lightwell
