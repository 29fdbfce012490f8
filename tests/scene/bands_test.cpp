#include "scene/bands.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

namespace lightwell::bands_test {
namespace {

// The integrals that CIE 15 states have five digits.
constexpr double rounding = 1e-4;

Eigen::Array3d tristimulus(const Bands& bands) {
  return bands.xyz.cast<double>().rowwise().sum();
}

TEST(RgbBands, OneWattOfWhiteIsTheLuminousEfficacy) {
  // The three weights have seven decimals.
  EXPECT_NEAR(luminous(rgb_bands(), Spectrum::Ones(3)), 683.0, 683.0 * 3e-7);
  EXPECT_NEAR(luminous(rgb_bands(179.0), Spectrum::Ones(3)), 179.0, 179.0 * 3e-7);
}

TEST(RgbBands, LuminanceWeightsAreRec709) {
  const Bands bands = rgb_bands();
  constexpr std::array weights = {0.2126, 0.7152, 0.0722};  // ITU-R BT.709, four decimals
  for (int k = 0; k < 3; ++k) {
    Spectrum one = Spectrum::Zero(3);
    one[k] = 1.0f;
    EXPECT_NEAR(luminous(bands, one) / 683.0, weights[static_cast<std::size_t>(k)], 1e-4);
  }
}

TEST(RgbBands, AreShownAsTheyAre) {
  const Spectrum values = (Spectrum(3) << 0.2f, 3.0f, 0.0f).finished();
  EXPECT_TRUE((linear_rgb(rgb_bands(), values) == values.head<3>()).all());
}

TEST(SpectralBands, HaveTheirCentresAndNames) {
  const Bands bands = spectral_bands(400, 700, 3);
  EXPECT_EQ(bands.count(), 3);
  EXPECT_EQ(bands.names[0], "400-500nm");
  EXPECT_EQ(bands.wavelengths_nm, (std::vector<double>{450, 550, 650}));
}

TEST(SpectralBands, EqualEnergySumsToTheIntegralsOfTheColourMatchingFunctions) {
  // CIE 1931 standard observer, 360-830 nm: the integrals of x, y, z are 106.87, 106.86, 106.89 nm.
  const Bands bands = spectral_bands(360, 830, 94);
  const Eigen::Array3d integral = 5.0 * tristimulus(bands);
  EXPECT_NEAR(integral[0], 106.87, rounding * 106.87);
  EXPECT_NEAR(integral[1], 106.86, rounding * 106.86);
  EXPECT_NEAR(integral[2], 106.89, rounding * 106.89);
}

TEST(SpectralBands, EqualEnergyWhiteHasChromaticityOneThird) {
  const Eigen::Array3d xyz = tristimulus(spectral_bands(360, 830, 94));
  // Relative errors e of the three sums move x = X / (X + Y + Z) by at most (4/9) e; the table's
  // own integrals differ by 3.3e-4.
  EXPECT_NEAR(xyz[0] / xyz.sum(), 1.0 / 3.0, 4.0 / 9.0 * 3.3e-4);
  EXPECT_NEAR(xyz[1] / xyz.sum(), 1.0 / 3.0, 4.0 / 9.0 * 3.3e-4);
}

TEST(SpectralBands, TheEyeIsMostSensitiveAt555Nanometres) {
  const Bands bands = spectral_bands(554.5, 555.5, 1);
  EXPECT_NEAR(luminous(bands, Spectrum::Ones(1)), 683.0, 683.0 * rounding);
  // CIE 1931 at 555 nm: x, y = 0.3374, 0.6589, four decimals.
  const Eigen::Array3d xyz = tristimulus(bands);
  EXPECT_NEAR(xyz[0] / xyz.sum(), 0.3374, 1e-4);
  EXPECT_NEAR(xyz[1] / xyz.sum(), 0.6589, 1e-4);
}

TEST(SpectralBands, TotalDoesNotDependOnHowTheSpectrumIsCut) {
  // A constant 1 W/nm is `width` W in each band. Each band has its exact mean, in a float.
  double first = 0.0;
  for (int count : {10, 30, 75}) {
    const Bands bands = spectral_bands(400, 700, count);
    const double lumens = luminous(bands, constant_spectrum(bands, 300.0f / count));
    if (first == 0.0) first = lumens;
    EXPECT_NEAR(lumens, first, 1e-6 * first) << count;
  }
}

TEST(SpectralBands, DisplayedColourHasTheLuminanceOfTheSpectrum) {
  const Bands bands = spectral_bands(400, 700, 30);
  Spectrum values(30);
  for (int k = 0; k < 30; ++k) values[k] = 1.0f + 0.5f * std::sin(0.3f * static_cast<float>(k));
  const Spectrum rgb = linear_rgb(bands, values);
  // The tolerance allows for float matrices of condition number 5 with 30 terms.
  EXPECT_NEAR(luminous(rgb_bands(), rgb), luminous(bands, values), 1e-5 * luminous(bands, values));
}

TEST(SpectralBands, RefuseImpossibleRanges) {
  EXPECT_THROW(spectral_bands(700, 400, 3), std::invalid_argument);
  EXPECT_THROW(spectral_bands(300, 700, 3), std::invalid_argument);
  EXPECT_THROW(spectral_bands(400, 900, 3), std::invalid_argument);
  EXPECT_THROW(spectral_bands(400, std::nan(""), 3), std::invalid_argument);
  EXPECT_THROW(spectral_bands(400, 700, 0), std::invalid_argument);
  EXPECT_THROW(spectral_bands(400, 700, max_bands + 1), std::invalid_argument);
  EXPECT_EQ(spectral_bands(400, 700, max_bands).count(), max_bands);
}

}  // namespace
}  // namespace lightwell::bands_test
