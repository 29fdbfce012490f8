#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "viewer/export/appearance.h"

namespace lightwell {

/// 8-bit sRGB, 3 bytes a pixel, row 0 on top.
struct LegendPicture {
  int width = 0, height = 0;
  std::vector<std::uint8_t> rgb{};
};

/// Values of `width` x `height` pixels in the false colours of the window, and to the right of them
/// the scale with its numbers and `unit`; small pictures are put on black as high as the scale
/// needs. Needs no display. Throws std::runtime_error if text cannot be drawn.
LegendPicture with_legend(const std::vector<float>& values, int width, int height,
                          const LuxRange& range, const std::string& unit);

}  // namespace lightwell
