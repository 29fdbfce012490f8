#include "raytrace/compare.h"

#include <gtest/gtest.h>

#include <limits>

#include "scene/errors.h"
#include "tests/temporary_folder.h"

namespace lightwell {
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
  // 1 + 2^-20 against 1 everywhere: float sums over 3e5 values would lose it.
  const ImageDifference d =
      compare_images(flat_image(512, 200, 1.0f + 0x1p-20f), flat_image(512, 200, 1.0f));
  EXPECT_NEAR(d.rmse, 0x1p-20, 1e-6 * 0x1p-20);
}

TEST(CompareImages, PerceptualDifferenceOfBlackAndWhiteIsNearlyOne) {
  // White through the shoulder is 1 - exp(-...) of full; black is 0: Oklab lightness 0 to almost 1.
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
}  // namespace lightwell
