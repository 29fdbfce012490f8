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

/// Returns the box of a scale alone: title, bar, ticks and their numbers, in letters of `font`
/// pixels and about `height` pixels high, more if the numbers need more. Throws as with_legend().
LegendPicture draw_legend(const LuxRange& range, const std::string& unit, int font, int height);

/// Draws a legend as draw_legend() does, of the classes of illuminance (see lux_classes).
LegendPicture draw_class_legend(int font, int height);

}  // namespace lightwell
