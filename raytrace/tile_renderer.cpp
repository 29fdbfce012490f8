#include "raytrace/tile_renderer.h"

#include <algorithm>
#include <array>
#include <optional>
#include <span>
#include <utility>

#include "raytrace/pixel_mean.h"
#include "scene/parallel.h"

namespace lightwell {
namespace {

// Corners of the pixel of column x between two rows of corners: those of the rows, or, where a
// panel ends, ones traced anew in the pixel's own panel.
class PixelCorners {
 public:
  PixelCorners(const Eye& eye, int x, int y, const CornerRow& top, const CornerRow& bottom)
      : corners_{&top[x], &top[x + 1], &bottom[x], &bottom[x + 1]} {
    const int panel = eye.panel_of_pixel(x, y);
    for (int c = 1; c < 4; ++c) {
      const int right = x + (c & 1), below = y + (c >> 1);
      if (eye.panel_of_pixel(right, below) == panel) continue;
      own_[c] = eye.trace(right * lattice_steps, below * lattice_steps, panel);
      corners_[c] = &own_[c];
    }
  }
  const std::array<const RaySample*, 4>& operator*() const { return corners_; }

 private:
  std::array<RaySample, 4> own_{};
  std::array<const RaySample*, 4> corners_;
};

// Pixels that many samples are taken of, beside subdivision.
struct SampledPixels {
  const PixelSamples& samples;
  const GlossMask& mask;
};

void trace_corners(const Eye& eye, int first_row, std::span<CornerRow> rows,
                   const GlossMask* mask = nullptr) {
  constexpr int grain = 32;
  const int columns = static_cast<int>(rows.front().size());
  parallel_for(static_cast<int>(rows.size()) * columns, grain, [&](int begin, int end) {
    for (int i = begin; i < end; ++i) {
      const int row = i / columns, column = i % columns;
      if (mask && !mask->is_corner_of_matt_pixel(column, first_row + row)) continue;
      const int y = first_row + row;
      rows[row][column] =
          eye.trace(column * lattice_steps, y * lattice_steps, eye.panel_of_pixel(column, y));
    }
  });
}

void count_samples(const PixelTally& tally, RayCounters& counters) {
  counters.eye_rays += tally.count;
  counters.depth_cut += tally.sum.depth_cut;
  counters.add_cut(double{tally.sum.cut_weight});
}

// Fills pixels by subdivision. Those of `sampled` are left out, except where subdivision finds
// gloss that no corner shows.
void average_pixels(const Eye& eye, const RenderOptions& options, int first_row,
                    std::span<const CornerRow> corners, const SampledPixels* sampled,
                    RayCounters& counters, Image& image, LayerFilm& layers) {
  constexpr int grain = 32;
  const int rows = static_cast<int>(corners.size()) - 1;
  parallel_for(rows * image.width, grain, [&](int begin, int end) {
    PixelMean pixel_mean(eye, options);
    for (int i = begin; i < end; ++i) {
      const int row = i / image.width, x = i % image.width, y = first_row + row;
      if (sampled && sampled->mask.has_gloss(x, y)) continue;
      const PixelCorners pixel_corners(eye, x, y, corners[row], corners[row + 1]);
      const PixelValue value = pixel_mean(x, y, *pixel_corners);
      if (sampled && pixel_mean.met_gloss()) {
        // Gloss that no corner shows is small, and few samples might miss it as well.
        constexpr int times = 4;
        PixelTally tally = sampled->samples.first_samples(x, y, times);
        sampled->samples.take_more(x, y, {}, tally);
        set_pixel(sampled->samples.mean(tally), x, y, image, layers);
        count_samples(tally, counters);
        continue;
      }
      const Eigen::Index pixel = Eigen::Index{y} * image.width + x;
      image.radiance.row(pixel) = value.radiance.transpose();
      layers.set_sampled(pixel, value.layers);
    }
  });
}

int rows_of_tile(Sampled sampled, const RunControl& run, int width) {
  // A pixel of gloss takes up to some ten milliseconds. A journal numbers tiles, whatever the time.
  constexpr int pixels_in_limited_time = 2048;
  if (run.has_limit() && !run.journal) return std::max(1, pixels_in_limited_time / width);
  constexpr int sampled_rows = 24;
  if (sampled != Sampled::none) return sampled_rows;
  constexpr int pixels_per_tile = 8192;
  return std::max(1, pixels_per_tile / width);
}

}  // namespace

TileRenderer::TileRenderer(const Eye& eye, const PixelSamples& samples, Sampled sampled,
                           const RenderOptions& options, RayCounters& counters, Image& image,
                           LayerFilm& layers)
    : eye_(eye),
      samples_(samples),
      row_sampler_(samples, image, layers),
      sampled_(sampled),
      options_(options),
      counters_(counters),
      image_(image),
      layers_(layers),
      tile_rows_(rows_of_tile(sampled, options.run, image.width)),
      corners_(tile_rows_ + 1, CornerRow(image.width + 1)) {}

void TileRenderer::render(int first_row, int rows) {
  if (sampled_ == Sampled::all) return sample(first_row, rows, nullptr);
  if (sampled_ == Sampled::none) return subdivide(first_row, rows, nullptr);
  const int above = std::max(0, first_row - sampled_neighbours);
  const int below = std::min(image_.height, first_row + rows + sampled_neighbours);
  const GlossMask mask = eye_.gloss(image_.width, above, below);
  subdivide(first_row, rows, &mask);
  sample(first_row, rows, &mask);
}

void TileRenderer::sample(int first_row, int rows, const GlossMask* only) {
  const double part = static_cast<double>(first_row) / image_.height;
  const SampledRows took = row_sampler_.sample(
      first_row, rows, [&] { report(options_.run.progress, "render", part); }, only);
  counters_.eye_rays += took.samples;
  counters_.depth_cut += took.depth_cut;
  counters_.add_cut(took.cut_weight);
}

void TileRenderer::subdivide(int first_row, int rows, const GlossMask* mask) {
  const auto count = static_cast<std::size_t>(rows);
  if (row_of_corners_ != first_row) {
    // The tile above counts these corners.
    RayCounters unread;
    const Eye eye = first_row > 0 ? eye_.counting_in(unread) : eye_;
    trace_corners(eye, first_row, {corners_.data(), 1}, mask);
  }
  trace_corners(eye_, first_row + 1, {corners_.data() + 1, count}, mask);
  std::optional<SampledPixels> sampled;
  if (mask) sampled.emplace(SampledPixels{.samples = samples_, .mask = *mask});
  average_pixels(eye_, options_, first_row, {corners_.data(), count + 1},
                 sampled ? &*sampled : nullptr, counters_, image_, layers_);
  std::swap(corners_.front(), corners_[rows]);
  row_of_corners_ = first_row + rows;
}

}  // namespace lightwell
