#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>
#include <vector>

namespace lightwell {

/// Upper left corner of a packed rectangle in one of several squares.
struct PackedPosition {
  int square = 0, x = 0, y = 0;
};

/// Packs rectangles (width, height) without overlap into squares of edge `square_size`, in order of
/// falling height. Each goes into the first square that has room, as far up and then as far left as
/// the skyline of earlier rectangles permits (Jylänki 2010, "A thousand ways to pack the bin",
/// skyline bottom-left). Empty if `most_squares` squares cannot hold the rectangles.
std::optional<std::vector<PackedPosition>> pack_rectangles(std::span<const Eigen::Vector2i> sizes,
                                                           int square_size, int most_squares);

}  // namespace lightwell
