#pragma once

#include <filesystem>
#include <memory>

#include "scene/bands.h"
#include "scene/environment_map.h"

namespace lightwell {

/// Reads an environment map of linear r, g, b radiance: OpenEXR (.exr) or a RADIANCE picture (.hdr,
/// .pic, .rgbe), whose EXPOSURE is divided out. Throws InputError naming the file and the fault:
/// missing, truncated, without R, G and B, values negative or not finite, more than 2^26 pixels.
std::shared_ptr<const EnvironmentMap> read_environment_map(const std::filesystem::path& path);

/// Linear r, g and b of a picture without a bound, rows from the top.
struct LightPixels {
  int width = 0, height = 0;
  BandArray rgb{};  ///< pixels x 3, >= 0
};

/// Pixels of an OpenEXR file or a RADIANCE picture, as read_environment_map() reads them. Throws
/// InputError as there.
LightPixels read_light_pixels(const std::filesystem::path& path);

/// Linear r, g and b of a RADIANCE picture, pixels x 3 from the top left, as they stand in the
/// file: its EXPOSURE is not divided out. Throws InputError as read_environment_map().
BandArray read_rgbe_values(const std::filesystem::path& path);

}  // namespace lightwell
