#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "scene/scene.h"

namespace lightwell {

/// Reads the materials of an MTL file (RGB bands; mapping in docs/scene-format.md). Omissions and
/// changes are added to `notes`. Throws InputError naming file, line, value and remedy.
std::vector<Material> read_obj_materials(const std::filesystem::path& path,
                                         std::vector<std::string>& notes);

}  // namespace lightwell
