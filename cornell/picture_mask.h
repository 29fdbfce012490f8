#pragma once

#include <functional>
#include <vector>

#include "cornell/sightlines.h"
#include "raytrace/pictures/image.h"

namespace lightwell {

/// Pixels that are left out of a comparison: 1 = out.
struct PictureMask {
  int width = 0, height = 0;
  std::vector<char> out{};

  PictureMask(int w, int h) : width(w), height(h), out(static_cast<std::size_t>(w) * h, 0) {}
  char& at(int x, int y) { return out[static_cast<std::size_t>(y) * width + x]; }
  char at(int x, int y) const { return out[static_cast<std::size_t>(y) * width + x]; }
  /// Share of the picture that is left out, [0,1].
  double share() const;
  /// Leaves out what the other does, too.
  PictureMask& operator|=(const PictureMask& other);
};

/// Pixels whose largest band reaches `radiance`.
PictureMask brighter_than(const Image& image, double radiance);

/// Pixels whose four corners do not all see the same surface straight ahead: silhouettes, and edges
/// between surfaces.
PictureMask silhouettes(const Sightlines& sightlines, const Camera& camera);

/// Pixels that show, with at least `least_weight`, a place that `is_out` picks: one look through
/// each quarter of the pixel.
PictureMask places(const Sightlines& sightlines, const Camera& camera, double least_weight,
                   const std::function<bool(const TracedPoint&)>& is_out);

/// Everything within `pixels` of what is out already (a square around it).
PictureMask grown(const PictureMask& mask, int pixels);

/// A mask of cells of size x size pixels; a cell is out if any of its pixels is.
PictureMask cells(const PictureMask& mask, int size);

/// Means over cells of size x size pixels.
Image cell_means(const Image& image, int size);

}  // namespace lightwell
