#pragma once

#include <cstdint>

#include "raytrace/gloss_mask.h"
#include "raytrace/layer_film.h"
#include "raytrace/pictures/image.h"
#include "raytrace/pixel_samples.h"
#include "scene/progress.h"

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

/// Fills `rows` rows of a picture from `first_row` on, and their sampled layers, by many samples
/// per pixel. The result of a row does not depend on the other rows filled with it: the first
/// samples of the neighbouring rows are taken too, see PixelSamples::take_more. With `only`, which
/// covers all these rows, pixels without gloss keep their values. Reports progress `part`
/// throughout.
SampledRows sample_rows(const PixelSamples& samples, int first_row, int rows,
                        const Progress& progress, double part, Image& image, LayerFilm& layers,
                        const GlossMask* only = nullptr);

}  // namespace lightwell
