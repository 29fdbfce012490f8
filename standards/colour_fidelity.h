#pragma once

#include <filesystem>
#include <optional>
#include <string_view>
#include <vector>

#include "scene/spectrum_samples.h"
#include "standards/eye_light.h"

namespace lightwell {

/// Reflectances of the 99 colour evaluation samples of CIE 224:2017 and ANSI/IES TM-30-20.
using ColourSamples = std::vector<SpectrumSamples>;

/// Reads colour evaluation samples from a CSV file: wavelengths from 380 to 780 nm, and 99
/// reflectances for each; a first line of names may precede them. Throws InputError naming file,
/// line and remedy.
ColourSamples read_colour_samples(const std::filesystem::path& path);

/// Colour rendition of ANSI/IES TM-30-20.
struct ColourFidelity {
  double fidelity = 0.0;  ///< R_f, 0 to 100, which is also that of CIE 224:2017
  double gamut = 0.0;     ///< R_g, 100 for the reference
  /// Bounds of their errors by the width of the intervals: the differences that
  /// in_wider_intervals() makes; NaN: unknown.
  double fidelity_within = 0.0, gamut_within = 0.0;
};

/// R_f and R_g of a light:
///
///     R_f = 10 ln(exp(R / 10) + 1)        R = 100 - 6.73 mean of dE of the samples in CAM02-UCS
///     R_g = 100 A_test / A_reference      A: of the polygon of the means in 16 bins of hue
///
/// for the CIE 1964 observer, by the reference of the same temperature: the black body up to 4000
/// K, CIE daylight from 5000 K on, and a mixture between. Empty where no temperature is defined
/// (see EyeLight), or it is above 25 000 K.
std::optional<ColourFidelity> colour_fidelity(const SpectralPower& power,
                                              const ColourSamples& samples);

namespace standards_data {
extern const std::string_view colour_matching_10;  ///< the bytes of colour_matching_10.csv
}  // namespace standards_data

}  // namespace lightwell
