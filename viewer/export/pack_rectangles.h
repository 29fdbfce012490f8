#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>
#include <vector>

namespace lightwell {

/// Where a rectangle came to lie: its upper left corner in one of several squares.
struct PackedPosition {
  int square = 0, x = 0, y = 0;
};

/// Puts rectangles (width, height) side by side into squares of that size, the highest first, each
/// as far up and then as far left as the skyline of those before lets it, in the first square that
/// has room (Jylänki 2010, "A thousand ways to pack the bin", skyline bottom-left). Empty if
/// `most_squares` do not hold them.
std::optional<std::vector<PackedPosition>> pack_rectangles(std::span<const Eigen::Vector2i> sizes,
                                                           int square_size, int most_squares);

}  // namespace lightwell
