#pragma once

#include <array>
#include <cstddef>

#include "viewer/export/appearance.h"

namespace lightwell {

/// Maintained illuminances that lighting standards ask for (EN 12464-1), lx: 100 corridors, 200
/// canteens and stores, 300 classrooms and filing, 500 reading and writing, 750 technical drawing.
inline constexpr std::array<double, 5> lux_classes = {100.0, 200.0, 300.0, 500.0, 750.0};
inline constexpr std::size_t class_count = lux_classes.size() + 1;

/// Colour, sRGB in [0,1], of the class with `reached` of the illuminances reached.
inline Eigen::Array3f class_color(std::size_t reached) {
  return false_color(static_cast<float>(reached) / static_cast<float>(class_count - 1));
}

}  // namespace lightwell
