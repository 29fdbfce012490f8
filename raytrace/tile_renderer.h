#pragma once

#include <vector>

#include "raytrace/eye.h"
#include "raytrace/layer_film.h"
#include "raytrace/pictures/image.h"
#include "raytrace/pixel_samples.h"
#include "raytrace/sampled_rows.h"

namespace lightwell {

/// The pixels that get many samples.
enum class Sampled { none, with_gloss, all };

/// A row of pixel corners, each as a point of the panel to its right and below.
using CornerRow = std::vector<RaySample>;

/// Renderer of tiles, which are strips of full rows. Strips share a row of corners; pixels that are
/// `sampled` hold many samples instead.
class TileRenderer {
 public:
  TileRenderer(const Eye& eye, const PixelSamples& samples, Sampled sampled,
               const RenderOptions& options, RayCounters& counters, Image& image,
               LayerFilm& layers);

  /// Rows of a tile: few enough to stop soon and to lose little, enough to keep all threads busy;
  /// fewer in limited time, of which a tile that is not finished would waste much.
  int tile_rows() const { return tile_rows_; }
  /// Fills radiance and sampled layers of a tile.
  void render(int first_row, int rows);

 private:
  void sample(int first_row, int rows, const GlossMask* only);
  void subdivide(int first_row, int rows, const GlossMask* mask);

  const Eye& eye_;
  const PixelSamples& samples_;
  RowSampler row_sampler_;
  Sampled sampled_;
  const RenderOptions& options_;
  RayCounters& counters_;
  Image& image_;
  LayerFilm& layers_;
  int tile_rows_;
  std::vector<CornerRow> corners_;
  int row_of_corners_ = -1;  // row of corners_.front(); -1: none yet
};

}  // namespace lightwell
