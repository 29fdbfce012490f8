#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "viewer/export/appearance.h"

namespace lightwell {

/// A picture in 8-bit sRGB, 3 bytes a pixel, row 0 on top.
struct LegendPicture {
  int width = 0, height = 0;
  std::vector<std::uint8_t> rgb{};
};

/// Returns `values` (width x height, row 0 on top) in the window's false colours, with the scale,
/// its numbers and `unit` to the right. A picture lower than the scale is extended in black. Needs
/// no display. Throws std::runtime_error if text cannot be drawn.
LegendPicture with_legend(const std::vector<float>& values, int width, int height,
                          const LuxRange& range, const std::string& unit);

}  // namespace lightwell
