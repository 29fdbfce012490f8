#pragma once

#include <string>

#include "raytrace/image.h"

namespace lightwell {

struct ImageDifference {
  double rmse = 0.0;           ///< sqrt(mean (A-B)^2) over pixels and bands, in the images' unit
  double relative_rmse = 0.0;  ///< rmse / mean of B
  double max_difference = 0.0;
  double mean_a = 0.0, mean_b = 0.0;
  double perceptual = 0.0;  ///< mean per-pixel difference of the tone-mapped pictures, [0,1]
};

/// Compares A with the reference B. Throws InputError unless the sizes match.
ImageDifference compare_images(const Image& a, const Image& b);

/// |A - B| in false colour (8-bit sRGB, 3 bytes a pixel); white is `full_scale` and above.
std::vector<std::uint8_t> difference_picture(const Image& a, const Image& b, double full_scale);

}  // namespace lightwell
