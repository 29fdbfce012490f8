#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <optional>

#include "scene/spectrum_samples.h"
#include "standards/eye_light.h"

namespace lightwell {

/// Wavelengths from and to which receptors and test colours have values, nm.
inline constexpr double first_receptor_nm = 380.0, last_receptor_nm = 780.0;

/// Visits the parts of a power's intervals between these wavelengths: visit(low, high, watts).
template <class Visit>
void for_each_visible_interval(const SpectralPower& power, Visit&& visit) {
  for (std::size_t k = 0; k < power.watts.size(); ++k) {
    const double low = std::max(power.edges_nm[k], first_receptor_nm);
    const double high = std::min(power.edges_nm[k + 1], last_receptor_nm);
    if (!(low < high) || power.watts[k] == 0.0) continue;
    visit(low, high, power.watts[k] * ((high - low) / (power.edges_nm[k + 1] - power.edges_nm[k])));
  }
}

/// CIE 1931 X, Y and Z of light that a surface of `reflectance` reflects, null for a white one,
/// W/m^2 times the colour-matching functions.
Eigen::Vector3d tristimulus(const SpectralPower& power,
                            const SpectrumSamples* reflectance = nullptr);

/// CIE 1960 u, v of a CIE 1931 chromaticity.
Eigen::Vector2d uv_of(double x, double y);

/// Power of a black body of `kelvin`, in intervals of 1 nm around 380 to 780 nm, 1 at 560 nm.
SpectralPower black_body_power(double kelvin);

/// The black body next to a light.
struct NearestBlackBody {
  double kelvin = 0.0;
  double duv =
      0.0;  ///< distance in CIE 1960 u, v; positive where v is above that of the black body
  bool is_at_end = false;  ///< true: a black body outside of the range could be nearer
};

/// Returns the black body, from 1000 to 100 000 K, whose chromaticity is next to `uv`, to 1e-6 of
/// its temperature.
NearestBlackBody nearest_black_body(const Eigen::Vector2d& uv);

/// R_a of CIE 13.3-1995: the mean index of test colours 1 to 8 below the light and below its
/// reference, which is the black body of the same temperature below 5000 K and CIE daylight above.
/// Empty if |Duv| exceeds 5.4e-3, where CIE 13.3 does not define R_a, or if no daylight has the
/// temperature.
std::optional<double> general_colour_rendering(const SpectralPower& power,
                                               const NearestBlackBody& nearest);

}  // namespace lightwell
