#include "standards/eye_light.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <vector>

#include "scene/black_body.h"
#include "standards/colour_rendering.h"

namespace lightwell::eye_light_test {
namespace {

constexpr double first_nm = 380.0;

// Intervals of `step` nm around samples from 380 nm on.
SpectralPower around_samples(const std::vector<double>& samples, double step) {
  SpectralPower power{.edges_nm = {first_nm - 0.5 * step}};
  for (std::size_t i = 0; i < samples.size(); ++i) {
    power.edges_nm.push_back(first_nm + (static_cast<double>(i) + 0.5) * step);
    power.watts.push_back(samples[i]);
  }
  return power;
}

// CIE illuminant A, the black body of 2848 K by the old constant c_2, 2856 K by the new one.
SpectralPower illuminant_a() {
  std::vector<double> samples;
  for (int nm = 380; nm <= 780; ++nm) samples.push_back(black_body_radiance(nm, 2855.5));
  return around_samples(samples, 1.0);
}

// CIE 15, illuminants FL2 and FL11, 380 to 780 nm in steps of 5 nm.
const std::vector<double> fl2 = {
    1.18,  1.48,  1.84,  2.15,  3.44,  15.69, 3.85,  3.74,  4.19,  4.62,  5.06,  34.98,
    11.81, 6.27,  6.63,  6.93,  7.19,  7.40,  7.54,  7.62,  7.65,  7.62,  7.62,  7.45,
    7.28,  7.15,  7.05,  7.04,  7.16,  7.47,  8.04,  8.88,  10.01, 24.88, 16.64, 14.59,
    16.16, 17.56, 18.62, 21.47, 22.79, 19.29, 18.66, 17.73, 16.54, 15.21, 13.80, 12.36,
    10.95, 9.65,  8.40,  7.32,  6.31,  5.43,  4.68,  4.02,  3.45,  2.96,  2.55,  2.19,
    1.89,  1.64,  1.53,  1.27,  1.10,  0.99,  0.88,  0.76,  0.68,  0.61,  0.56,  0.54,
    0.51,  0.47,  0.47,  0.43,  0.46,  0.47,  0.40,  0.33,  0.27};
const std::vector<double> fl11 = {
    0.91,  0.63, 0.46, 0.37, 1.29,  12.68, 1.59,  1.79,  2.46,  3.33, 4.49, 33.94, 12.13, 6.95,
    7.19,  7.12, 6.72, 6.13, 5.46,  4.79,  5.66,  14.29, 14.96, 8.97, 4.72, 2.33,  1.47,  1.10,
    0.89,  0.83, 1.18, 4.90, 39.59, 72.84, 32.61, 7.52,  2.83,  1.96, 1.67, 4.43,  11.28, 14.76,
    12.73, 9.74, 7.33, 9.72, 55.27, 42.58, 13.18, 13.16, 12.26, 5.11, 2.07, 2.34,  3.58,  3.01,
    2.48,  2.14, 1.54, 1.33, 1.46,  1.94,  2.00,  1.20,  1.35,  4.10, 5.58, 2.51,  0.57,  0.27,
    0.23,  0.21, 0.24, 0.24, 0.20,  0.24,  0.32,  0.26,  0.16,  0.12, 0.09};

/// CIE S 026:2018, table 2: alpha-opic efficacy of luminous radiation of D65, mW/lm, four decimals.
/// How D65 is interpolated between the 5 nm of its table moves the last digit by one; so does
/// rounding by half.
TEST(EyeLight, OfDaylightHasTheEfficaciesOfTheStandard) {
  constexpr std::array published = {0.8173, 1.4558, 1.6289, 1.4497, 1.3262};
  const EyeLight light = *eye_light(daylight_illuminant(6504.0));
  EXPECT_NEAR(light.lux, 1.0, 1e-12);
  for (std::size_t a = 0; a < published.size(); ++a) {
    EXPECT_NEAR(1000.0 * light.alpha_opic[a] / light.lux, published[a], 1.5e-4)
        << receptor_name(static_cast<Receptor>(a));
    EXPECT_NEAR(light.equivalent_daylight[a], light.lux, 1.5e-4 / published[a]);
  }
}

/// Daylight efficacy ratios of CIE S 026's toolbox for illuminants A and E, four decimals.
TEST(EyeLight, OfStandardIlluminantsHasThePublishedRatios) {
  constexpr std::array of_a = {0.3110, 0.8066, 1.0171, 0.5731, 0.4958};
  constexpr std::array of_e = {0.9255, 0.9594, 1.0061, 0.9175, 0.9058};
  const EyeLight a = *eye_light(illuminant_a());
  const EyeLight e = *eye_light(around_samples(std::vector<double>(401, 1.0), 1.0));
  for (std::size_t i = 0; i < of_a.size(); ++i) {
    EXPECT_NEAR(a.equivalent_daylight[i] / a.lux, of_a[i], 1e-4) << i;
    EXPECT_NEAR(e.equivalent_daylight[i] / e.lux, of_e[i], 1e-4) << i;
  }
  EXPECT_NEAR(a.melanopic_ratio(), 0.4958, 1e-4);
}

/// The lines of a fluorescent lamp, known in steps of 5 nm, leave the ratio open by how they are
/// interpolated: 0.5630 by even intervals, 0.5636 by a smooth curve through the samples.
TEST(EyeLight, OfAFluorescentLampIsThatOfItsTable) {
  EXPECT_NEAR(eye_light(around_samples(fl11, 5.0))->melanopic_ratio(), 0.5633, 6e-4);
}

/// CIE 15: CCT of A 2856 K, D65 6504 K with Duv 0.0032, FL2 4230 K, FL11 4000 K (rounded to 10 K).
/// Constants of Planck's law by ITS-90 move A by 1 K.
TEST(EyeLight, HasTheColourTemperaturesOfTheTables) {
  const EyeLight a = *eye_light(illuminant_a());
  EXPECT_NEAR(*a.colour_temperature, 2855.5, 0.1);
  EXPECT_NEAR(a.duv, 0.0, 1e-6);
  const EyeLight day = *eye_light(daylight_illuminant(6504.0));
  EXPECT_NEAR(*day.colour_temperature, 6503.7, 1.5);
  EXPECT_NEAR(day.duv, 0.0032, 5e-5);
  EXPECT_NEAR(day.x, 0.3127, 5e-5);
  EXPECT_NEAR(day.y, 0.3290, 5e-5);
  EXPECT_NEAR(*eye_light(around_samples(fl2, 5.0))->colour_temperature, 4230.0, 10.0);
  EXPECT_NEAR(*eye_light(around_samples(fl11, 5.0))->colour_temperature, 4000.0, 10.0);
}

/// CIE 15: R_a of FL2 64 and of FL11 83, whole numbers; black bodies and daylight have 100.
TEST(EyeLight, HasTheColourRenderingOfTheTables) {
  EXPECT_NEAR(*eye_light(illuminant_a())->colour_rendering, 100.0, 0.01);
  EXPECT_NEAR(*eye_light(daylight_illuminant(6504.0))->colour_rendering, 100.0, 0.1);
  EXPECT_NEAR(*eye_light(around_samples(fl2, 5.0))->colour_rendering, 64.0, 0.5);
  EXPECT_NEAR(*eye_light(around_samples(fl11, 5.0))->colour_rendering, 83.0, 0.5);
}

/// Bands from 400 to 700 nm lose 0.09 % of the melanopic irradiance of an even spectrum.
TEST(EyeLight, OfTheBandsOfASceneIsThatOfTheirSpectrum) {
  const Bands bands = spectral_bands(400, 700, 60);
  const EyeLight cut = *eye_light(*spectral_power(bands, constant_spectrum(bands, 5.0f)));
  const EyeLight whole = *eye_light(around_samples(std::vector<double>(401, 1.0), 1.0));
  EXPECT_NEAR(cut.lux, luminous(bands, constant_spectrum(bands, 5.0f)), 1e-5 * cut.lux);
  EXPECT_NEAR(1.0 - cut.alpha_opic[4] / whole.alpha_opic[4], 0.0009, 0.00005);
}

TEST(EyeLight, NeedsWavelengthsAndLight) {
  EXPECT_FALSE(spectral_power(rgb_bands(), Spectrum::Ones(3)).has_value());
  const Bands bands = spectral_bands(400, 700, 10);
  EXPECT_FALSE(eye_light(*spectral_power(bands, Spectrum::Zero(10))).has_value());
}

/// A black body of 800 K is redder than the coolest of the search.
TEST(EyeLight, BeyondTheBlackBodiesOfTheSearchHasNoColourTemperature) {
  std::vector<double> samples;
  for (int nm = 380; nm <= 780; ++nm) samples.push_back(black_body_radiance(nm, 800.0));
  EXPECT_FALSE(eye_light(around_samples(samples, 1.0))->colour_temperature.has_value());
}

/// Green light of one wavelength has no colour temperature, and no R_a.
TEST(EyeLight, FarFromBlackBodiesHasNoColourTemperature) {
  std::vector<double> samples(401, 0.0);
  samples[140] = 1.0;  // 520 nm
  const EyeLight green = *eye_light(around_samples(samples, 1.0));
  EXPECT_FALSE(green.colour_temperature.has_value());
  EXPECT_FALSE(green.colour_rendering.has_value());
  EXPECT_GT(green.duv, 0.05);
}

// Three lines of 10 nm (standard deviation) as a white lamp of 4800 K has them, in intervals of
// `step` nm, each with the power of its part.
SpectralPower three_lines(double step) {
  struct Line {
    double nm, height;
  };
  SpectralPower power{.edges_nm = {first_nm}};
  for (double low = first_nm; low < 780.0 - 1e-9; low += step) {
    double sum = 0.0;
    for (double nm = low + 0.25; nm < low + step; nm += 0.5) {
      for (const auto& [peak, height] : {Line{450.0, 0.8}, Line{545.0, 1.2}, Line{610.0, 1.0}}) {
        sum += height * std::exp(-0.5 * std::pow((nm - peak) / 10.0, 2));
      }
    }
    power.edges_nm.push_back(low + step);
    power.watts.push_back(sum);
  }
  return power;
}

/// The bound of R_a covers the error of wide intervals, against intervals of 1 nm, and shrinks with
/// them. Daylight has R_a of 100 by definition; nothing is known of a green light.
TEST(EyeLight, BoundsTheErrorOfColourRendering) {
  const auto exact = rated_colour(three_lines(1.0));
  ASSERT_TRUE(exact);
  double wider = exact->within;
  for (const double step : {2.0, 5.0, 10.0}) {
    const auto rated = rated_colour(three_lines(step));
    ASSERT_TRUE(rated) << step;
    EXPECT_LE(std::abs(rated->rendering - exact->rendering), rated->within) << step;
    EXPECT_GT(rated->within, wider) << step;
    wider = rated->within;
  }
  EXPECT_NEAR(rated_colour(daylight_illuminant(6504.0))->rendering, 100.0, 0.1);
  SpectralPower green = three_lines(5.0);
  for (std::size_t k = 0; k < green.watts.size(); ++k) {
    if (green.edges_nm[k] < 500.0 || green.edges_nm[k] > 570.0) green.watts[k] = 0.0;
  }
  EXPECT_FALSE(rated_colour(green));
}

}  // namespace
}  // namespace lightwell::eye_light_test
