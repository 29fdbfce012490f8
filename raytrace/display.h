#pragma once

#include <Eigen/Core>

#include "raytrace/image.h"

namespace lightwell {

/// Display values: 1 is the screen's white.

/// The shoulder of the automatic tone mapping, one channel: x up to 0.5, above that
/// 0.5 + 0.5 (1 - exp(-(x - 0.5) / 0.5)), which continues value and slope and tends to 1.
float shoulder(float x);

/// Hable's curve, one channel, as published with its white at 11.2 and twice the exposure: x = 5.6
/// and more is white. (J. Hable, "Uncharted 2: HDR Lighting", GDC 2010.)
float filmic(float x);

/// sRGB transfer function (IEC 61966-2-1) of a linear value; what lies outside [0,1] is clipped.
float srgb_encode(float linear);

/// What a pixel shows, linear, [0,1]: scaled linear RGB through the curve. Values that are no
/// numbers show black, so that one bad pixel is seen and does no harm.
Eigen::Array3f display_rgb(const Eigen::Array3f& linear, double scale,
                           ToneCurve curve = ToneCurve::shoulder);

}  // namespace lightwell
