#pragma once

#include <filesystem>
#include <memory>

#include "scene/environment_map.h"

namespace lightwell {

/// Reads an environment map with radiance in linear r, g and b: OpenEXR (.exr) or a picture of
/// RADIANCE (.hdr, .pic, .rgbe), whose EXPOSURE is divided out. Throws InputError naming the file
/// and what is wrong: missing, torn, without R, G and B, negative or not finite, or larger than
/// 2^26 pixels.
std::shared_ptr<const EnvironmentMap> read_environment_map(const std::filesystem::path& path);

}  // namespace lightwell
