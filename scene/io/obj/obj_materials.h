#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "scene/io/remarks.h"
#include "scene/scene.h"

namespace lightwell {

/// Reads those materials of an MTL file of which `is_shown(name)` is true (RGB bands; mapping in
/// docs/scene-format.md). Omissions and changes are added to `remarks`. A picture that is missing
/// or damaged is left out; its material keeps its plain colour, or a reflectance of 0.5 without
/// one. A material with a line that cannot be read is grey. Throws InputError naming the file and
/// what is wrong with it.
std::vector<Material> read_obj_materials(const std::filesystem::path& path,
                                         const std::function<bool(const std::string&)>& is_shown,
                                         Remarks& remarks);

}  // namespace lightwell
