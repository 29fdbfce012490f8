#pragma once

#include <limits>
#include <string>
#include <vector>

#include "raytrace/image.h"

namespace lightwell {

struct CompareOptions {
  /// Pixels of which the reference is above that in any band are left out, lamps for one; in the
  /// images' unit.
  double exclude_above = std::numeric_limits<double>::infinity();
  /// Compares means over squares of so many pixels, of what is not left out: noise that is finer
  /// counts less. What does not fill a square at the right and the bottom is one of its own.
  int block = 1;
};

struct BandDifference {
  std::string band{};
  double rmse = 0.0;           ///< sqrt(mean (A-B)^2)
  double relative_rmse = 0.0;  ///< rmse / mean of B
  double max_difference = 0.0;
  double mean_a = 0.0, mean_b = 0.0;
};

struct ImageDifference {
  double rmse = 0.0;           ///< sqrt(mean (A-B)^2) over pixels and bands, in the images' unit
  double relative_rmse = 0.0;  ///< rmse / mean of B
  double max_difference = 0.0;
  double mean_a = 0.0, mean_b = 0.0;
  double excluded = 0.0;  ///< share of the pixels that were left out
  /// R, G, B, and the spectral bands among the layers where both images have some.
  std::vector<BandDifference> bands{};
  // Of all pixels, tone-mapped under the reference's exposure.
  double perceptual = 0.0;  ///< mean distance in Oklab, [0,1]
  double flip = 0.0;        ///< mean FLIP, [0,1]
  double hdr_flip = 0.0;    ///< mean FLIP at the worst of all exposures, [0,1]
};

/// Compares A with the reference B. Throws InputError unless the sizes match, spectral bands are
/// the same in both or missing in one, and all numbers are finite; or if everything is left out.
ImageDifference compare_images(const Image& a, const Image& b, const CompareOptions& options = {});

/// What is left of a difference when the reference's noise is taken away.
struct HalvesDifference {
  /// mean (A-H1)(A-H2) over pixels and bands: the expectation of (A - truth)^2 where the noise of
  /// both halves is independent; below zero by chance where A is exact.
  double mean_square = 0.0;
  double rmse = 0.0;             ///< its root, 0 where it is negative
  double relative_rmse = 0.0;    ///< rmse / mean of the halves
  double reference_noise = 0.0;  ///< RMS error of the halves' mean, sqrt(mean (H1-H2)^2) / 2
  double mean_a = 0.0, mean_reference = 0.0;
  double excluded = 0.0;
};

/// Compares A with two references of the same thing and independent noise. Pixels are left out by
/// the halves' mean. Throws as compare_images.
HalvesDifference compare_with_halves(const Image& a, const Image& first, const Image& second,
                                     const CompareOptions& options = {});

/// |A - B| in false colour (8-bit sRGB, 3 bytes a pixel); white is `full_scale` and above.
std::vector<std::uint8_t> difference_picture(const Image& a, const Image& b, double full_scale);

}  // namespace lightwell
