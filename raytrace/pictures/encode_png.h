#pragma once

#include <cstdint>
#include <span>
#include <string>

namespace lightwell {

/// Returns the bytes of a PNG file, for files that embed pictures. `pixels` are sRGB-encoded, 3
/// bytes each or 4 with alpha, row 0 on top. Throws std::runtime_error if libpng fails.
std::string encode_png(int width, int height, std::span<const std::uint8_t> pixels);

}  // namespace lightwell
