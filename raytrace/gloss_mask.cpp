#include "raytrace/gloss_mask.h"

#include <algorithm>

#include "scene/parallel.h"

namespace lightwell {

GlossMask::GlossMask(const CameraRays& rays, const RayTree& tree, int width, int first, int end)
    : width_(width), first_(first), end_(end) {
  constexpr int grain = 64;
  const int columns = width + 1, rows = end - first;
  std::vector<char> corners(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows + 1));
  parallel_for(static_cast<int>(corners.size()), grain, [&](int begin, int stop) {
    for (int i = begin; i < stop; ++i) {
      const double x = i % columns, y = first + i / columns;
      const auto ray = rays.ray_at(x, y);
      corners[static_cast<std::size_t>(i)] = ray && tree.sees_gloss(*ray) ? 1 : 0;
    }
  });
  gloss_.resize(static_cast<std::size_t>(width) * static_cast<std::size_t>(rows));
  for (int y = first; y < end; ++y) {
    for (int x = 0; x < width; ++x) {
      // A corner at the end of a panel lies in the next one, but this pixel's ray does not.
      const int panel = rays.panel_at(x + 0.5, y + 0.5);
      const auto is_glossy = [&](int column, int row) {
        if (rays.panel_at(column, row) == panel) {
          return corners[static_cast<std::size_t>((row - first) * columns + column)] != 0;
        }
        const auto ray = rays.ray_at(column, row, panel);
        return ray && tree.sees_gloss(*ray);
      };
      const bool any =
          is_glossy(x, y) || is_glossy(x + 1, y) || is_glossy(x, y + 1) || is_glossy(x + 1, y + 1);
      gloss_[slot(x, y)] = any ? 1 : 0;
    }
  }
}

bool GlossMask::is_corner_of_matt_pixel(int x, int y) const {
  for (int j = std::max(first_, y - 1); j < std::min(end_, y + 1); ++j) {
    for (int i = std::max(0, x - 1); i < std::min(width_, x + 1); ++i) {
      if (!has_gloss(i, j)) return true;
    }
  }
  return false;
}

}  // namespace lightwell
