#pragma once

#include "raytrace/image.h"

namespace lightwell {

/// Pixels in a degree of sight: a screen 3840 pixels and 0.7 m wide, seen from 0.7 m.
inline constexpr double usual_pixels_per_degree = 67.02064327658226;

/// The difference that people see when two pictures alternate, per pixel, [0,1]: FLIP of Andersson,
/// Nilsson, Akenine-Moller, Oskarsson, Astrom & Fairchild 2020 ("FLIP: A Difference Evaluator for
/// Alternating Images"). Colours filtered by the eye's contrast sensitivity and compared by their
/// HyAB distance in L*a*b* with Hunt's effect, more where edges or points differ.
///
/// `radiance` of both is what a screen shows, linear RGB; what is outside [0,1] is clipped. Throws
/// InputError unless both have RGB and the same size.
Eigen::ArrayXf flip(const Image& picture, const Image& reference,
                    double pixels_per_degree = usual_pixels_per_degree);

/// Exposures, in stops, between which HDR-FLIP looks at pictures.
struct FlipExposures {
  double first = 0.0, last = 0.0;
  int count = 2;
};

/// Those in which the brightest pixel of the reference, and its median, reach 85 % of white; about
/// one stop apart. Where more than half of it is black, the median of the rest.
FlipExposures flip_exposures(const Image& reference);

/// The same for light without a top: the largest FLIP of any exposure, through the ACES curve
/// (Andersson, Nilsson, Shirley & Akenine-Moller 2021, "Visualizing Errors in Rendered High Dynamic
/// Range Images"; curve of Narkowicz 2016).
Eigen::ArrayXf hdr_flip(const Image& picture, const Image& reference,
                        double pixels_per_degree = usual_pixels_per_degree);

}  // namespace lightwell
