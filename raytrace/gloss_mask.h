#pragma once

#include <cstddef>
#include <vector>

#include "raytrace/cameras/camera_ray.h"
#include "raytrace/shading/shade.h"

namespace lightwell {

/// Pixels of some rows of a picture that show a rough surface, directly or in smooth mirrors and
/// glass: those with such a corner. Needs one ray without shading per corner.
class GlossMask {
 public:
  /// Covers the rows from `first` to `end` of a picture of `width` columns, 0 <= first < end.
  GlossMask(const CameraRays& rays, const RayTree& tree, int width, int first, int end);

  /// Returns whether pixel (x, y) shows a rough surface; y in [first, end).
  bool has_gloss(int x, int y) const { return gloss_[slot(x, y)] != 0; }
  /// Returns whether the corner at the top left of pixel (x, y) belongs to a pixel of these rows
  /// without gloss; x up to the width, y up to `end`.
  bool is_corner_of_matt_pixel(int x, int y) const;

 private:
  std::size_t slot(int x, int y) const {
    return static_cast<std::size_t>(y - first_) * static_cast<std::size_t>(width_) +
           static_cast<std::size_t>(x);
  }

  int width_, first_, end_;
  std::vector<char> gloss_;
};

}  // namespace lightwell
