#include "raytrace/display/compare.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "scene/errors.h"
#include "scene/sampling.h"
#include "tests/temporary_folder.h"

namespace lightwell::compare_test {
namespace {

Image flat_image(int width, int height, float L) {
  Image image{.width = width, .height = height};
  image.radiance.setConstant(width * height, 3, L);
  return image;
}

TEST(CompareImages, EqualImagesDoNotDiffer) {
  const ImageDifference d = compare_images(flat_image(4, 4, 0.3f), flat_image(4, 4, 0.3f));
  EXPECT_EQ(d.rmse, 0.0);
  EXPECT_EQ(d.relative_rmse, 0.0);
  EXPECT_EQ(d.max_difference, 0.0);
  EXPECT_EQ(d.perceptual, 0.0);
  EXPECT_EQ(d.flip, 0.0);
  EXPECT_EQ(d.hdr_flip, 0.0);
}

TEST(CompareImages, FiguresFollowTheirDefinitions) {
  // One of 12 values is off by 3: rmse = sqrt(9 / 12), mean of A = (12 * 2 + 3) / 12.
  Image a = flat_image(2, 2, 2.0f);
  a.radiance(3, 1) = 5.0f;
  const ImageDifference d = compare_images(a, flat_image(2, 2, 2.0f));
  EXPECT_DOUBLE_EQ(d.rmse, std::sqrt(9.0 / 12.0));
  EXPECT_DOUBLE_EQ(d.relative_rmse, std::sqrt(9.0 / 12.0) / 2.0);
  EXPECT_DOUBLE_EQ(d.max_difference, 3.0);
  EXPECT_DOUBLE_EQ(d.mean_a, 27.0 / 12.0);
  EXPECT_DOUBLE_EQ(d.mean_b, 2.0);
}

TEST(CompareImages, SumsInDoubleKeepSmallDifferencesOfLargeImages) {
  // Float sums over 3e5 values would lose the difference 2^-20 from 1.
  const ImageDifference d =
      compare_images(flat_image(512, 200, 1.0f + 0x1p-20f), flat_image(512, 200, 1.0f));
  EXPECT_NEAR(d.rmse, 0x1p-20, 1e-6 * 0x1p-20);
}

TEST(CompareImages, PerceptualDifferenceOfBlackAndWhiteIsNearlyOne) {
  // Black has Oklab lightness 0; white through the shoulder of the tone curve has almost 1.
  Image reference = flat_image(100, 10, 0.18f);
  const ImageDifference far = compare_images(flat_image(100, 10, 1e4f), flat_image(100, 10, 0.0f));
  EXPECT_NEAR(far.perceptual, 1.0, 1e-3);
  const ImageDifference near = compare_images(flat_image(100, 10, 0.19f), reference);
  EXPECT_GT(near.perceptual, 0.0);
  EXPECT_LT(near.perceptual, 0.02);  // 5 % in light is a fiftieth of the lightness range
}

TEST(CompareImages, MismatchAndBrokenPixelsAreNamed) {
  EXPECT_TRUE(
      says(message_of<InputError>([] { compare_images(flat_image(4, 2, 1), flat_image(2, 4, 1)); }),
           "4 x 2 and 2 x 4"));
  Image broken = flat_image(4, 2, 1);
  broken.radiance(6, 0) = std::numeric_limits<float>::quiet_NaN();
  EXPECT_TRUE(says(message_of<InputError>([&] { compare_images(flat_image(4, 2, 1), broken); }),
                   "second image has a value that is not finite at pixel (2, 1)"));
}

TEST(CompareImages, BandsAreJudgedOneByOne) {
  Image a = flat_image(4, 1, 2.0f);
  a.radiance.col(1) += 1.0f;
  a.radiance(0, 2) -= 1.0f;
  const ImageDifference d = compare_images(a, flat_image(4, 1, 2.0f));
  ASSERT_EQ(d.bands.size(), 3u);
  EXPECT_EQ(d.bands[0].band, "R");
  EXPECT_EQ(d.bands[0].rmse, 0.0);
  EXPECT_DOUBLE_EQ(d.bands[1].relative_rmse, 0.5);
  EXPECT_DOUBLE_EQ(d.bands[1].mean_a, 3.0);
  EXPECT_DOUBLE_EQ(d.bands[2].rmse, 0.5);  // one of four pixels is off by 1
}

// A picture with RGB, a spectral band and a layer.
Image spectral_image(float band) {
  Image image = flat_image(2, 2, 1.0f);
  image.layers.names = {"500-510nm", "depth.Z"};
  image.layers.values.resize(4, 2);
  image.layers.values.col(0).setConstant(band);
  image.layers.values.col(1).setConstant(std::numeric_limits<float>::infinity());
  return image;
}

TEST(CompareImages, SpectralBandsAreBandsAndLayersAreNot) {
  const ImageDifference d = compare_images(spectral_image(3.0f), spectral_image(2.0f));
  ASSERT_EQ(d.bands.size(), 4u);
  EXPECT_EQ(d.bands[3].band, "500-510nm");
  EXPECT_DOUBLE_EQ(d.bands[3].relative_rmse, 0.5);
  EXPECT_EQ(d.rmse, 0.0);
}

TEST(CompareImages, OtherBandsAreRefusedByNameAndRgbIsComparedWhereOneHasNone) {
  Image other = spectral_image(1.0f);
  other.layers.names[0] = "510-520nm";
  const auto message = message_of<InputError>([&] { compare_images(spectral_image(1.0f), other); });
  EXPECT_TRUE(says(message, "the second image has no channel '500-510nm'")) << message;
  EXPECT_EQ(compare_images(spectral_image(1.0f), flat_image(2, 2, 1.0f)).bands.size(), 3u);
  EXPECT_EQ(compare_images(flat_image(2, 2, 1.0f), spectral_image(1.0f)).bands.size(), 3u);
  Image broken = spectral_image(1.0f);
  broken.layers.values(3, 0) = std::numeric_limits<float>::quiet_NaN();
  EXPECT_TRUE(says(message_of<InputError>([&] { compare_images(broken, spectral_image(1.0f)); }),
                   "channel '500-510nm' at pixel (1, 1)"));
}

TEST(CompareImages, WhatIsAboveTheBoundIsLeftOut) {
  Image a = flat_image(4, 1, 1.0f), b = a;
  b.radiance.row(2) = 100.0f;  // a lamp that A misses
  a.radiance.row(0) = 2.0f;
  const ImageDifference d = compare_images(a, b, {.exclude_above = 50.0});
  EXPECT_DOUBLE_EQ(d.rmse, std::sqrt(1.0 / 3.0));
  EXPECT_DOUBLE_EQ(d.mean_b, 1.0);
  EXPECT_DOUBLE_EQ(d.excluded, 0.25);
  EXPECT_TRUE(says(message_of<InputError>([&] { compare_images(a, b, {.exclude_above = 0.5}); }),
                   "nothing is left"));
}

TEST(CompareImages, BlocksCompareMeansAndLeaveOutWhatIsExcluded) {
  // Alternating noise of +1 and -1 has mean 0 over 2 x 2 pixels; a shift of 0.5 has mean 0.5.
  Image a = flat_image(5, 4, 2.5f);
  const Image b = flat_image(5, 4, 2.0f);
  for (int y = 0; y < 4; ++y) {
    for (int x = 0; x < 4; ++x) a.radiance.row(5 * y + x) += (x + y) % 2 == 0 ? 1.0f : -1.0f;
  }
  EXPECT_DOUBLE_EQ(compare_images(a, b, {.block = 2}).rmse, 0.5);
  EXPECT_GT(compare_images(a, b).rmse, 0.5);
  // The lamp's pixel is left out of its square; the rest of the square counts as much as any other
  // square. The mean of the rest is (1.5 + 1.5 + 3.5) / 3; there are 3 x 2 squares.
  Image lamp = b;
  lamp.radiance.row(0) = 9.0f;
  const double off = 6.5 / 3.0 - 2.0;
  EXPECT_NEAR(compare_images(a, lamp, {.exclude_above = 5.0, .block = 2}).rmse,
              std::sqrt((5 * 0.25 + off * off) / 6), 1e-7);
  EXPECT_THROW(compare_images(a, b, {.block = 0}), InputError);
}

// A picture of 1 plus uniform noise in [-0.3, 0.3), of variance 0.3^2 / 3.
Image noisy(std::uint64_t seed) {
  Image image = flat_image(100, 100, 1.0f);
  for (Eigen::Index i = 0; i < image.radiance.size(); ++i) {
    const double u = random_uniform(random_key(seed, static_cast<std::uint64_t>(i)));
    image.radiance.data()[i] += static_cast<float>(0.6 * u - 0.3);
  }
  return image;
}

TEST(CompareWithHalves, NoiseOfTheReferencesCancels) {
  const double variance = 0.03, n = 30000;
  for (const float off : {0.0f, 0.02f}) {
    const HalvesDifference d =
        compare_with_halves(flat_image(100, 100, 1.0f + off), noisy(1), noisy(2));
    // The product of two independent errors has the variance v^2 + 2 off^2 v, with v that of one
    // error; the tolerance is five standard errors.
    const double tolerance = 5 * std::sqrt((variance * variance + 2 * off * off * variance) / n);
    EXPECT_NEAR(d.mean_square, off * off, tolerance);
    EXPECT_EQ(d.rmse, std::sqrt(std::max(0.0, d.mean_square)));
    // The RMS of the mean of two is sqrt(variance / 2), with a relative error below 1 / sqrt(n).
    EXPECT_NEAR(d.reference_noise, std::sqrt(variance / 2), 5 * std::sqrt(variance / 2 / n));
    // The ordinary comparison includes the noise, which dominates the squared error.
    EXPECT_GT(compare_images(flat_image(100, 100, 1.0f + off), noisy(1)).rmse, 0.15);
  }
}

TEST(CompareWithHalves, EqualHalvesAreAnOrdinaryComparison) {
  const Image a = noisy(3), b = noisy(4);
  const CompareOptions options{.exclude_above = 1.25, .block = 3};
  const HalvesDifference halves = compare_with_halves(a, b, b, options);
  const ImageDifference plain = compare_images(a, b, options);
  EXPECT_NEAR(halves.rmse, plain.rmse, 1e-12);
  EXPECT_NEAR(halves.relative_rmse, plain.relative_rmse, 1e-12);
  EXPECT_EQ(halves.excluded, plain.excluded);
  EXPECT_EQ(halves.reference_noise, 0.0);
}

TEST(CompareWithHalves, OtherSizesAreRefused) {
  EXPECT_THROW(compare_with_halves(flat_image(2, 2, 1), flat_image(2, 2, 1), flat_image(4, 1, 1)),
               InputError);
}

TEST(DifferencePicture, BlackWhereEqualWhiteAtFullScale) {
  Image a = flat_image(3, 1, 1.0f);
  a.radiance.row(1) += 0.5f;
  a.radiance.row(2) += 7.0f;
  const auto bytes = difference_picture(a, flat_image(3, 1, 1.0f), 1.0);
  EXPECT_EQ(std::vector(bytes.begin(), bytes.begin() + 3), std::vector<std::uint8_t>({0, 0, 0}));
  EXPECT_NE(bytes[3], 0);
  EXPECT_NE(bytes[4], 255);
  EXPECT_EQ(std::vector(bytes.begin() + 6, bytes.end()),
            std::vector<std::uint8_t>({255, 255, 255}));
  EXPECT_THROW(difference_picture(a, a, 0.0), InputError);
}

}  // namespace
}  // namespace lightwell::compare_test
