#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <vector>

#include "scene/texture.h"

namespace lightwell {

/// A rectangle of a picture, in texels from its top left corner.
struct TexelRect {
  double left = 0.0, right = 0.0, top = 0.0, bottom = 0.0;

  double area() const { return (right - left) * (bottom - top); }
  bool is_empty() const { return !(right > left && bottom > top); }
  bool contains(double x, double y) const {
    return x >= left && x < right && y >= top && y < bottom;
  }
  /// The part that both rectangles cover; is_empty() if they do not meet.
  TexelRect within(const TexelRect& other) const;
};

/// Exact integrals of a picture over rectangles in constant time, by a summed-area table (Crow
/// 1984). Texels are flat squares. The sums are whole numbers, so that black gives exactly 0.
class PictureSums {
 public:
  /// The table takes 8 bytes for each texel and channel.
  explicit PictureSums(std::shared_ptr<const Texture> picture);

  const Texture& picture() const { return *picture_; }
  TexelRect whole() const;
  /// Integral of r, g and b over a part of whole(), texels.
  Eigen::Array3d over(const TexelRect& window) const;

 private:
  double block(int left, int right, int top, int bottom, int channel) const;

  std::shared_ptr<const Texture> picture_;
  // Sums of the square codes of all texels above and to the left of each corner, row by row.
  std::vector<std::uint64_t> sums_{};
};

}  // namespace lightwell
