#include "scene/rgb_basis.h"

#include <algorithm>
#include <array>
#include <cstddef>

namespace lightwell {
namespace {

// R and G at 380, 390, ... 730 nm: of all functions in [0,1] that, with B = 1 - R - G, have the
// colours of the primaries under D65 (CIE 15, 10 nm) by the colour matching of bands.cpp, those of
// the least sum of squared differences between neighbours. The functions are made for light whose
// white is (1, 1, 1). tests/scene/rgb_basis_test.cpp checks colours, bounds and smoothness.
constexpr double first_nm = 380.0, step_nm = 10.0;
constexpr std::array<std::array<float, 36>, 2> red_and_green = {{
    {0.03477f, 0.03497f, 0.03555f, 0.03634f, 0.03525f, 0.03127f, 0.02655f, 0.01994f, 0.02325f,
     0.00000f, 0.00000f, 0.00000f, 0.00000f, 0.00000f, 0.00000f, 0.00000f, 0.00000f, 0.00000f,
     0.00000f, 0.00261f, 0.19811f, 0.48214f, 0.75487f, 0.93775f, 1.00000f, 1.00000f, 1.00000f,
     1.00000f, 1.00000f, 1.00000f, 1.00000f, 1.00000f, 0.99968f, 0.99931f, 0.99913f, 0.99906f},
    {0.00000f, 0.00000f, 0.00000f, 0.00000f, 0.00000f, 0.00000f, 0.00000f, 0.00000f, 0.00110f,
     0.12136f, 0.30008f, 0.50841f, 0.71065f, 0.87773f, 0.98207f, 1.00000f, 1.00000f, 1.00000f,
     1.00000f, 0.94327f, 0.74715f, 0.48862f, 0.24106f, 0.06225f, 0.00000f, 0.00000f, 0.00000f,
     0.00000f, 0.00000f, 0.00000f, 0.00000f, 0.00000f, 0.00022f, 0.00048f, 0.00062f, 0.00067f},
}};

// Value of a function at a wavelength, linear between its samples.
float function_at(const std::array<float, 36>& function, double nm) {
  const double place =
      std::clamp((nm - first_nm) / step_nm, 0.0, static_cast<double>(function.size() - 1));
  const auto low = std::min(static_cast<std::size_t>(place), function.size() - 2);
  const auto part = static_cast<float>(place - static_cast<double>(low));
  return (1.0f - part) * function[low] + part * function[low + 1];
}

}  // namespace

RgbBasis::RgbBasis(const Bands& bands) {
  const std::vector<double>& centre = bands.wavelengths_nm;
  if (centre.empty()) return;
  // A single band is taken to be all visible light.
  const bool is_alone = centre.size() == 1;
  const double width = is_alone ? 300.0 : centre[1] - centre[0];
  per_band_.setZero(static_cast<Eigen::Index>(centre.size()), 3);
  constexpr int samples = 16;
  for (std::size_t k = 0; k < centre.size(); ++k) {
    const auto row = static_cast<Eigen::Index>(k);
    for (int s = 0; s < samples; ++s) {
      const double nm = (is_alone ? 550.0 : centre[k]) + width * ((s + 0.5) / samples - 0.5);
      for (int c = 0; c < 2; ++c) {
        per_band_(row, c) += function_at(red_and_green[static_cast<std::size_t>(c)], nm) / samples;
      }
    }
    per_band_(row, 2) = std::max(0.0f, 1.0f - per_band_(row, 0) - per_band_(row, 1));
  }
}

Spectrum RgbBasis::reflectance(const Eigen::Array3f& rgb) const {
  if (per_band_.rows() == 0) return rgb;
  return (per_band_.matrix() * rgb.matrix()).array();
}

}  // namespace lightwell
