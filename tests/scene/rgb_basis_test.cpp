#include "scene/rgb_basis.h"

#include <gtest/gtest.h>

#include <array>
#include <vector>

#include "scene/facet_textures.h"
#include "tests/scene/scene_file_test.h"

namespace lightwell::rgb_basis_test {
namespace {

// CIE's daylight D65 from 380 to 730 nm in steps of 10 nm (CIE 15).
constexpr std::array<double, 36> daylight = {
    49.9755, 54.6482, 82.7549, 91.486,  93.4318, 86.6823, 104.865, 117.008, 117.812,
    114.861, 115.923, 108.811, 109.354, 107.802, 104.790, 107.689, 104.405, 104.046,
    100.000, 96.3342, 95.788,  88.6856, 90.0062, 89.5991, 87.6987, 83.2886, 83.6992,
    80.0268, 80.2146, 82.2778, 78.2842, 69.7213, 71.6091, 74.349,  61.604,  69.8856};

const std::vector<Eigen::Array3f> colours = {
    {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0.8f, 0.3f, 0.1f}, {0.2f, 0.5f, 0.7f}, {0.4f, 0.4f, 0.4f}};

// Colours come back under daylight. Bands of 10 nm have the mean of functions that are linear
// between samples in the bands' middles, which differs from a sample by an eighth of the second
// difference, at most 0.016 in some of 36 bands: 0.02 of a primary.
TEST(RgbBasis, GivesBackColoursUnderDaylight) {
  const Bands bands = spectral_bands(375.0, 735.0, 36);
  Spectrum light(36);
  for (int k = 0; k < 36; ++k) light[k] = static_cast<float>(daylight[static_cast<std::size_t>(k)]);
  const Eigen::Array3f white = linear_rgb(bands, light);
  const RgbBasis basis(bands);
  for (const Eigen::Array3f& rgb : colours) {
    const Eigen::Array3f back = linear_rgb(bands, basis.reflectance(rgb) * light) / white;
    EXPECT_LT((back - rgb).abs().maxCoeff(), 0.02f) << rgb.transpose();
  }
}

// White is white and grey is grey in every band; no band reflects more than the largest share or
// less than the smallest. Three functions that add up to 1, their products with the colour and the
// sum of these: five roundings of half of epsilon.
TEST(RgbBasis, KeepsGreyAndBounds) {
  constexpr float rounding = 5 * 0x1p-24f;  // 2.98e-7
  for (const Bands& bands : {spectral_bands(400.0, 700.0, 76), spectral_bands(400.0, 700.0, 3),
                             spectral_bands(360.0, 830.0, 20), spectral_bands(500.0, 600.0, 1)}) {
    const RgbBasis basis(bands);
    for (const float grey : {1.0f, 0.3f}) {
      EXPECT_LT((basis.reflectance(Eigen::Array3f::Constant(grey)) - grey).abs().maxCoeff(),
                rounding);
    }
    for (const Eigen::Array3f& rgb : colours) {
      const Spectrum rho = basis.reflectance(rgb);
      EXPECT_LE(rho.maxCoeff(), rgb.maxCoeff() + rounding);
      EXPECT_GE(rho.minCoeff(), rgb.minCoeff() - rounding);
    }
  }
}

// No spikes: bands of 10 nm step by no more than samples do, of which the largest step is that of
// red from 580 to 590 nm. Colours are mixtures of the three functions.
TEST(RgbBasis, IsSmooth) {
  constexpr float largest_step = 0.48214f - 0.19811f;
  const RgbBasis basis(spectral_bands(375.0, 735.0, 36));
  for (const Eigen::Array3f& rgb : colours) {
    const Spectrum rho = basis.reflectance(rgb);
    EXPECT_LT((rho.tail(35) - rho.head(35)).abs().maxCoeff(), largest_step);
  }
}

TEST(RgbBasis, OfRgbBandsIsTheColour) {
  const Eigen::Array3f rgb(0.1f, 0.2f, 0.3f);
  EXPECT_TRUE((RgbBasis(rgb_bands()).reflectance(rgb) == Spectrum(rgb)).all());
}

class SpectralPictures : public test::SceneFileTest {};

// two-pixels.png is white on its left, black on its right.
TEST_F(SpectralPictures, AreReflectancesOfTheBands) {
  std::filesystem::copy(LIGHTWELL_TEST_DATA "/scene/two-pixels.png", folder / "p.png");
  const Scene scene = read_file(
      "a.toml",
      "bands = { kind = 'spectral', count = 10 }\n"
      "materials.rug = { reflectance = 0.8, texture = { file = 'p.png', filter = 'nearest' } }\n"
      "[[surfaces]]\nname = 'rug'\nmaterial = 'rug'\n"
      "polygon = [[0,0,0],[2,0,0],[2,1,0],[0,1,0]]\nuv = [[0,1],[1,1],[1,0],[0,0]]\n");
  const FacetTextures textures(scene);
  EXPECT_EQ(scene.materials[0].reflectance.size(), 10);
  // Texels of 0 and 1 are exact; five roundings as above and three of factors.
  constexpr float rounding = 8 * 0x1p-24f;
  EXPECT_LT((scene.materials[0].reflectance - 0.4f).abs().maxCoeff(), rounding);
  EXPECT_LT((textures.reflectance(0, {0.5, 0.5, 0.0}) - 0.8f).abs().maxCoeff(), rounding);
  EXPECT_EQ(textures.reflectance(0, {1.5, 0.5, 0.0}).abs().maxCoeff(), 0.0f);
}

}  // namespace
}  // namespace lightwell::rgb_basis_test
