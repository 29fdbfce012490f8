#pragma once

#include <filesystem>
#include <vector>

#include "scene/io/remarks.h"
#include "scene/scene.h"

namespace lightwell {

/// Reads the materials of an MTL file (RGB bands; mapping in docs/scene-format.md). Omissions and
/// changes are added to `remarks`. A picture that is missing or damaged is left out; its material
/// keeps its plain colour, or a reflectance of 0.5 without one. Throws InputError naming file,
/// line, value and remedy.
std::vector<Material> read_obj_materials(const std::filesystem::path& path, Remarks& remarks);

}  // namespace lightwell
