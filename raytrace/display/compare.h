#pragma once

#include <limits>
#include <string>
#include <vector>

#include "raytrace/pictures/image.h"

namespace lightwell {

struct CompareOptions {
  /// Pixels are left out if the reference exceeds this value in any band, for example pixels of
  /// lamps; in the images' unit, above 0.
  double exclude_above = std::numeric_limits<double>::infinity();
  /// Side in pixels, at least 1, of the squares whose means are compared. Means are over the pixels
  /// that are not left out, and noise finer than a square counts less. Remainders at the right and
  /// the bottom are squares of their own.
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
  double excluded = 0.0;  ///< share of pixels left out, [0,1]
  /// R, G, B (or numbered bands), then the spectral bands among the layers if both images have
  /// spectral bands.
  std::vector<BandDifference> bands{};
  // The figures below are means over all pixels, excluded ones too.
  /// Mean distance in Oklab of the pictures tone-mapped under the reference's exposure, [0,1].
  double perceptual = 0.0;
  /// Mean FLIP of the pictures tone-mapped under the reference's exposure, [0,1].
  double flip = 0.0;
  double hdr_flip = 0.0;  ///< mean HDR-FLIP, the largest FLIP of all exposures, [0,1]
};

/// Compares A with the reference B. Throws InputError if:
/// - sizes or numbers of bands differ, or there are no pixels;
/// - both images have spectral bands and the bands differ;
/// - a number is not finite;
/// - an option is out of range, or all pixels are left out.
ImageDifference compare_images(const Image& a, const Image& b, const CompareOptions& options = {});

/// Difference from a noisy reference, without the reference's noise.
struct HalvesDifference {
  /// Mean (A-H1)(A-H2) over pixels and bands. Its expectation is that of (A - truth)^2, since the
  /// noise of the two halves is independent. The value may be negative by chance where A is exact.
  double mean_square = 0.0;
  double rmse = 0.0;             ///< sqrt(mean_square), 0 where mean_square is negative
  double relative_rmse = 0.0;    ///< rmse / mean of the halves
  double reference_noise = 0.0;  ///< RMS error of the halves' mean, sqrt(mean (H1-H2)^2) / 2
  double mean_a = 0.0, mean_reference = 0.0;
  double excluded = 0.0;
};

/// Compares A with two references of the same scene and view whose noise is independent. Pixels are
/// left out by the mean of both references. Throws as compare_images.
HalvesDifference compare_with_halves(const Image& a, const Image& first, const Image& second,
                                     const CompareOptions& options = {});

/// |A - B|, the mean over bands, in false colour: 8-bit sRGB, 3 bytes a pixel. A difference of
/// `full_scale`, above 0, or more is white. Throws InputError as compare_images.
std::vector<std::uint8_t> difference_picture(const Image& a, const Image& b, double full_scale);

}  // namespace lightwell
