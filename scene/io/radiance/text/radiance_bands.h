#pragma once

#include "scene/bands.h"

namespace lightwell {

/// Luminous efficacy of white light in RADIANCE, lm/W (Ward & Shakespeare 1998).
inline constexpr double radiance_lumens_per_watt = 179.0;

/// Linear RGB with RADIANCE's primaries, R (0.640, 0.330), G (0.290, 0.600), B (0.150, 0.060) and
/// white (0.3333, 0.3333): luminance weights 0.265, 0.670, 0.065; radiance_lumens_per_watt.
Bands radiance_bands();

/// Luminance of r, g and b over that of white, by the weights of RADIANCE's primaries.
double radiance_luminance(const Spectrum& rgb);

}  // namespace lightwell
