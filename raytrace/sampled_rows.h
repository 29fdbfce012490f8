#pragma once

#include <cstdint>

#include "raytrace/image.h"
#include "raytrace/layer_film.h"
#include "raytrace/pixel_samples.h"
#include "scene/progress.h"

namespace lightwell {

/// What rows of a picture took.
struct SampledRows {
  std::int64_t samples = 0, depth_cut = 0;
  double cut_weight = 0.0;
};

/// Fills some rows of a picture, and their sampled layers, by many samples per pixel. Rows do not
/// depend on which others are filled with them: the first samples of those above and below are
/// taken too, see PixelSamples::take_more. Reports `part` of the picture as done all along.
SampledRows sample_rows(const PixelSamples& samples, int first_row, int rows,
                        const Progress& progress, double part, Image& image, LayerFilm& layers);

}  // namespace lightwell
