#pragma once

#include <cstdint>
#include <span>
#include <string>

namespace lightwell {

/// The bytes of a PNG file of sRGB-encoded pixels, 3 bytes each or 4 with alpha, row 0 on top, for
/// files that hold pictures. Throws std::runtime_error if the library cannot.
std::string encode_png(int width, int height, std::span<const std::uint8_t> pixels);

}  // namespace lightwell
