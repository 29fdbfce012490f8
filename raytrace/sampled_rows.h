#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <optional>
#include <vector>

#include "raytrace/gloss_mask.h"
#include "raytrace/layer_film.h"
#include "raytrace/pictures/image.h"
#include "raytrace/pixel_samples.h"

namespace lightwell {

/// Pixels on each side whose first samples tell of what a pixel's own may have missed. What fills
/// one in 250 of their 49 times 16 samples is missed by all of them beside one pixel in 23.
inline constexpr int sampled_neighbours = 3;

/// Work spent on rows of a picture.
struct SampledRows {
  std::int64_t samples = 0, depth_cut = 0;
  double cut_weight = 0.0;
};

/// Sets a pixel, and its sampled layers, to the mean of its samples, of which there is at least
/// one.
void set_pixel(const RaySample& mean, int x, int y, Image& image, LayerFilm& layers);

/// Sampler of rows of a picture by many samples per pixel. The result of a row does not depend on
/// the other rows filled with it: the first samples of the neighbouring rows are taken too, see
/// PixelSamples::take_more. Where rows follow those of the call before, first samples that both
/// need are taken once.
class RowSampler {
 public:
  RowSampler(const PixelSamples& samples, Image& image, LayerFilm& layers)
      : samples_(samples), image_(image), layers_(layers) {}

  /// Fills `rows` rows of the picture from `first_row` on, and their sampled layers. With `only`,
  /// which covers all these rows and their neighbours, pixels without gloss keep their values.
  /// `report_slice` is called by this thread between slices of pixels, and may throw.
  SampledRows sample(int first_row, int rows, const std::function<void()>& report_slice,
                     const GlossMask* only = nullptr);

 private:
  /// First samples of a row of pixels. Those of rows that are filled have no tallies any more.
  struct FirstSamples {
    std::vector<PixelTally> tallies{};
    std::vector<std::optional<NearbyNoise>> noisy{};
  };

  FirstSamples& row(int y) { return known_[static_cast<std::size_t>(y - top_)]; }
  void take_first(int top, int bottom, const std::function<void()>& report_slice,
                  const GlossMask* only);
  NearbyNoise noise_beside(int x, int y) const;

  const PixelSamples& samples_;
  Image& image_;
  LayerFilm& layers_;
  std::deque<FirstSamples> known_{};  // of the rows from top_ on
  int top_ = 0, next_row_ = -1;       // the row below those filled last; -1: none
};

}  // namespace lightwell
