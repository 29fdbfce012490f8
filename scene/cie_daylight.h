#pragma once

#include <Eigen/Core>

#include "scene/spectrum_samples.h"

namespace lightwell {

/// Correlated colour temperatures of CIE daylight, K.
inline constexpr double coolest_daylight = 4000.0, hottest_daylight = 25000.0;

/// CIE 1931 chromaticity x, y of CIE daylight of `kelvin`, 4000 to 25 000 (CIE 15:2018, Judd,
/// MacAdam & Wyszecki 1964). D65 has 6504 K.
Eigen::Vector2d daylight_chromaticity(double kelvin);

/// Relative spectral power of CIE daylight of `kelvin`, 100 at 560 nm, at 300 to 830 nm in steps of
/// 10 nm, linear between: S = S_0 + M_1 S_1 + M_2 S_2. M_1 and M_2 are not rounded.
SpectrumSamples daylight_spectrum(double kelvin);

}  // namespace lightwell
