#pragma once

#include <array>
#include <optional>
#include <string_view>
#include <vector>

#include "scene/bands.h"

namespace lightwell {

/// Receptors of the human eye (CIE S 026:2018).
enum class Receptor { s_cone, m_cone, l_cone, rhodopic, melanopic };
inline constexpr int receptor_count = 5;

/// Name of a receptor: "S-cone-opic", ..., "melanopic".
const char* receptor_name(Receptor receptor);

/// Light by what eyes and bodies make of it.
struct EyeLight {
  double lux = 0.0;
  /// Alpha-opic irradiance by receptor, W/m^2.
  std::array<double, receptor_count> alpha_opic{};
  /// Alpha-opic equivalent daylight (D65) illuminance by receptor, lx.
  std::array<double, receptor_count> equivalent_daylight{};
  double x = 0.0, y = 0.0;                     ///< CIE 1931 chromaticity
  std::optional<double> colour_temperature{};  ///< CCT, K; empty far from the black bodies
  double duv = 0.0;  ///< distance from the black bodies in CIE 1960 u, v; above them positive
  /// General colour rendering index R_a of CIE 13.3-1995; empty far from the black bodies, where it
  /// is not defined.
  std::optional<double> colour_rendering{};

  /// Melanopic daylight efficacy ratio.
  double melanopic_ratio() const {
    return equivalent_daylight[static_cast<std::size_t>(Receptor::melanopic)] / lux;
  }
};

/// Power by wavelength: the power in W/m^2 of each interval [edges k, edges k + 1] in nm.
struct SpectralPower {
  std::vector<double> edges_nm{}, watts{};
};

/// Power of the bands of a scene with wavelengths; empty for RGB, which knows none.
std::optional<SpectralPower> spectral_power(const Bands& bands, const Spectrum& values);

/// The quantities of a spectrum:
///
///     E_alpha = int s_alpha(l) E(l) dl        alpha-opic irradiance (CIE S 026:2018, eq. 1)
///     EDI_alpha = E_alpha / K_alpha,D65       K: E_alpha of D65 for one lux, as CIE S 026 has it
///     CCT: the black body next to the light in CIE 1960 u, v (CIE 15)
///     R_a = mean of 100 - 4.6 dE_i            over 8 test colours (CIE 13.3-1995)
///
/// Power is even within an interval; outside of the intervals there is none. Receptors and colours
/// have values from 380 to 780 nm. Empty without light.
std::optional<EyeLight> eye_light(const SpectralPower& power);

/// Power in intervals twice as wide: pairs of neighbours, from the first one on. Figures
/// change by about the error that the width of the intervals makes.
SpectralPower in_wider_intervals(const SpectralPower& power);

/// R_a of a light, and a bound of its error by the width of the intervals: the difference that
/// in_wider_intervals() makes; NaN if these have no R_a.
struct RatedColour {
  double rendering = 0.0, within = 0.0;
};
/// R_a of a light with its bound; empty where R_a is not defined (see EyeLight).
std::optional<RatedColour> rated_colour(const SpectralPower& power);

/// Power of a CIE daylight illuminant of `kelvin`, 4000 to 25 000, in intervals of 1 nm around 380
/// to 780 nm, of one lux (CIE 15). D65 is that of 6504 K.
SpectralPower daylight_illuminant(double kelvin);

namespace standards_data {
extern const std::string_view action_spectra;    ///< the bytes of action_spectra.csv
extern const std::string_view rendering_tables;  ///< the bytes of rendering_tables.csv
}  // namespace standards_data

}  // namespace lightwell
