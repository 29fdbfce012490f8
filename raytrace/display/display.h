#pragma once

#include <Eigen/Core>

#include "raytrace/pictures/image.h"

namespace lightwell {

/// Display values: 1 is the white of the screen.

/// Luminance Y of linear RGB (ITU-R BT.709).
double luminance(const Eigen::Array3f& rgb);

/// The shoulder of the automatic tone mapping, one channel: x up to 0.5, above that
/// 0.5 + 0.5 (1 - exp(-(x - 0.5) / 0.5)), which continues value and slope and tends to 1.
float shoulder(float x);

/// Hable's curve, one channel, as published with its white at 11.2 and twice the exposure: x = 5.6
/// and more is white. (J. Hable, "Uncharted 2: HDR Lighting", GDC 2010.)
float filmic(float x);

/// Narkowicz's fit to the tone curve of the Academy Color Encoding System, one channel: x (a x + b)
/// / (x (c x + d) + e), at most 1, which shows x = 1 as 0.8. (K. Narkowicz 2015, "ACES filmic tone
/// mapping curve".)
float aces_like(float x);
struct AcesFit {
  static constexpr double a = 2.51, b = 0.03, c = 2.43, d = 0.59, e = 0.14;
};

/// sRGB transfer function (IEC 61966-2-1) of a linear value, clipped to [0,1].
float srgb_encode(float linear);

/// Linear display RGB of a pixel, [0,1]: `linear` times `scale`, through the curve. NaN becomes 0,
/// so a bad pixel is visible as black and harms nothing else.
Eigen::Array3f display_rgb(const Eigen::Array3f& linear, double scale,
                           ToneCurve curve = ToneCurve::shoulder);

}  // namespace lightwell
