#pragma once

#include "raytrace/pictures/image.h"

namespace lightwell {

/// Pixels per degree of visual angle of a screen 3840 pixels and 0.7 m wide, seen from 0.7 m.
inline constexpr double usual_pixels_per_degree = 67.02064327658226;

/// FLIP, the visible difference when two pictures alternate, per pixel, [0,1] (Andersson, Nilsson,
/// Akenine-Moller, Oskarsson, Astrom & Fairchild 2020, "FLIP: A Difference Evaluator for
/// Alternating Images"). Colours are filtered by the eye's contrast sensitivity and compared by
/// their HyAB distance in L*a*b* with Hunt's effect. The difference grows where edges or points
/// differ.
///
/// `radiance` of both pictures is linear display RGB, clipped to [0,1]. Throws InputError unless
/// both have RGB and the same size.
Eigen::ArrayXf flip(const Image& picture, const Image& reference,
                    double pixels_per_degree = usual_pixels_per_degree);

/// Range of the exposures of HDR-FLIP, in stops, and their number.
struct FlipExposures {
  double first = 0.0, last = 0.0;
  int count = 2;
};

/// Exposures of HDR-FLIP for a reference. At the first exposure the reference's brightest pixel
/// reaches 85 % of white, at the last its median; steps are about one stop. If more than half of
/// the reference is black, the median is that of the other pixels.
FlipExposures flip_exposures(const Image& reference);

/// HDR-FLIP, per pixel, [0,1]: the largest FLIP over the exposures of flip_exposures(), each
/// through the ACES curve (Andersson, Nilsson, Shirley & Akenine-Moller 2021, "Visualizing Errors
/// in Rendered High Dynamic Range Images"; curve of Narkowicz 2016). `radiance` is linear RGB
/// without an upper bound. Throws as flip().
Eigen::ArrayXf hdr_flip(const Image& picture, const Image& reference,
                        double pixels_per_degree = usual_pixels_per_degree);

}  // namespace lightwell
