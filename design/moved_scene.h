#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "scene/scene.h"

namespace lightwell {

/// The text of the scene's file with the lamps where the scene has them, for a file in `folder`: of
/// the native format, otherwise empty. Only the positions of lamps that were moved, the points that
/// they look at, which become directions, and the paths of files that the scene names are other
/// than in the file; comments stay. Reading the text gives the same scene again, bit for bit, if
/// coordinates have six decimals at most in the unit of the file. Throws InputError if the file
/// cannot be read any more.
std::optional<std::string> moved_scene_text(const Scene& scene,
                                            const std::filesystem::path& folder);

}  // namespace lightwell
