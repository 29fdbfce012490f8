#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "raytrace/display.h"
#include "raytrace/image.h"
#include "scene/sampling.h"

namespace lightwell {
namespace {

Image flat_image(int width, int height, const Eigen::Array3f& L) {
  Image image{.width = width, .height = height};
  image.radiance = L.transpose().replicate(width * height, 1);
  return image;
}

// A wall whose luminance varies by a factor 16, as rooms do.
Image wall(int pixels) {
  Image image{.width = pixels, .height = 1};
  image.radiance.resize(pixels, 3);
  for (int i = 0; i < pixels; ++i) image.radiance.row(i) = std::exp2(4.0f * i / pixels);
  return image;
}

TEST(Srgb, PassesThroughThePointsOfTheStandard) {
  // IEC 61966-2-1: the two branches meet at 0.0031308 -> 0.04045; mid grey 0.2140 -> 0.5.
  EXPECT_EQ(srgb_encode(0.0f), 0.0f);
  EXPECT_FLOAT_EQ(srgb_encode(1.0f), 1.0f);
  EXPECT_NEAR(srgb_encode(0.0031308f), 0.04045f, 1e-5f);
  EXPECT_NEAR(srgb_encode(0.0031309f), 0.04045f, 1e-5f);
  EXPECT_NEAR(srgb_encode(0.21404f), 0.5f, 1e-4f);
}

TEST(Shoulder, IsSmoothRisingAndStaysBelowWhite) {
  constexpr float h = 1e-3f;
  EXPECT_FLOAT_EQ(shoulder(0.5f), 0.5f);
  EXPECT_NEAR((shoulder(0.5f + h) - shoulder(0.5f)) / h, 1.0f, 2 * h);  // slope goes on as 1
  float previous = -1.0f;
  for (float x = 0.0f; x < 4.0f; x += 0.01f) {
    EXPECT_GT(shoulder(x), previous);
    EXPECT_LT(shoulder(x), 1.0f);
    previous = shoulder(x);
  }
}

TEST(ToneMap, BrighterRadianceIsNeverDarkerOnScreen) {
  Image image{.width = 1000, .height = 1};
  image.radiance.resize(1000, 3);
  for (int i = 0; i < 1000; ++i) image.radiance.row(i) = std::exp2(0.02f * i - 10.0f);
  for (const bool automatic : {true, false}) {
    const auto bytes = tone_map(image, rgb_bands(), {.automatic = automatic});
    EXPECT_TRUE(std::is_sorted(bytes.begin(), bytes.end()));
  }
}

TEST(ToneMap, NeutralGreysStayNeutral) {
  const auto bytes = tone_map(wall(256), rgb_bands());
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    EXPECT_EQ(bytes[i], bytes[i + 1]);
    EXPECT_EQ(bytes[i], bytes[i + 2]);
  }
}

TEST(ToneMap, ExposureDoesNotDependOnTheUnitOfRadiance) {
  Image image = wall(256);
  const auto bytes = tone_map(image, rgb_bands());
  image.radiance *= 1024.0f;  // a power of two: no rounding
  EXPECT_EQ(tone_map(image, rgb_bands()), bytes);
}

TEST(ToneMap, LampsAndBlackDoNotMoveTheExposure) {
  const double without = exposure_scale(wall(1000), rgb_bands());
  Image image{.width = 1300, .height = 1};
  image.radiance.setZero(1300, 3);  // 200 pixels of black outside
  image.radiance.topRows(1000) = wall(1000).radiance;
  image.radiance.middleRows(1000, 100) = 1e4f;  // and a lamp
  // The median moves by at most 100 places of 1000, 0.4 stops, but the mean over the wall stays.
  EXPECT_NEAR(exposure_scale(image, rgb_bands()), without, 1e-6 * without);
}

TEST(ToneMap, OneStopDoublesTheScale) {
  const Image image = wall(64);
  for (const bool automatic : {true, false}) {
    const double base = exposure_scale(image, rgb_bands(), {.automatic = automatic});
    EXPECT_DOUBLE_EQ(exposure_scale(image, rgb_bands(), {.exposure_ev = 1, .automatic = automatic}),
                     2 * base);
  }
}

TEST(ToneMap, ManualIsPlainSrgbWithClipping) {
  const auto bytes = tone_map(flat_image(2, 2, {0.25f, 0.5f, 1.0f}), rgb_bands(),
                              {.exposure_ev = 1.0, .automatic = false});
  EXPECT_EQ(bytes[0], 188);  // 255 (1.055 0.5^(1/2.4) - 0.055) = 187.5
  EXPECT_EQ(bytes[1], 255);
  EXPECT_EQ(bytes[2], 255);
}

TEST(ToneMap, ColouredLampFarAboveWhiteShowsNearlyWhite) {
  Image image = wall(1000);
  image.radiance.row(0) << 1700.0f, 1180.0f, 400.0f;
  const auto bytes = tone_map(image, rgb_bands());
  EXPECT_GE(*std::min_element(bytes.begin(), bytes.begin() + 3), 250);
}

TEST(ToneMap, EdgePixelOfALampShowsTheMeanOfWhatLampAndWallShow) {
  // Columns of wall, 30 % lamp, lamp. Shown linear: 0.3 of the lamp's white + 0.7 of the wall's.
  Image image{.width = 101, .height = 3};
  image.radiance.setConstant(303, 3, 1.0f);
  for (int y = 0; y < 3; ++y) {
    image.radiance.row(101 * y + 99) = 0.3f * 500.0f + 0.7f * 1.0f;
    image.radiance.row(101 * y + 100) = 500.0f;
  }
  const auto bytes = tone_map(image, rgb_bands());
  const float wall = shoulder(static_cast<float>(exposure_scale(image, rgb_bands())));
  const float expected = 255.0f * srgb_encode(0.3f + 0.7f * wall);
  EXPECT_NEAR(bytes[3 * (101 + 99)], expected, 1.0);  // the lamp itself is a hair below 1
  EXPECT_NEAR(bytes[3 * (101 + 98)], 255.0f * srgb_encode(wall), 1.0);
  EXPECT_EQ(bytes[3 * (101 + 100)], 255);
}

TEST(ToneMap, BlackAndBrokenPixelsShowBlack) {
  EXPECT_EQ(tone_map(flat_image(1, 1, {0, 0, 0}), rgb_bands()), std::vector<std::uint8_t>(3, 0));
  Image image = wall(8);
  image.radiance.row(3).setConstant(std::numeric_limits<float>::quiet_NaN());
  const auto bytes = tone_map(image, rgb_bands());
  EXPECT_EQ(bytes[9], 0);
  EXPECT_GT(bytes[12], 0);
}

TEST(ToneMap, SpectralWhiteIsBrightAndColoursHaveTheirHue) {
  const Bands bands = spectral_bands(400, 700, 30);
  Image image{.width = 3, .height = 1};
  image.radiance.setConstant(3, 30, 0.1f);
  image.radiance.row(1).rightCols(20).setZero();  // 400-500 nm
  image.radiance.row(2).leftCols(20).setZero();   // 600-700 nm
  const auto bytes = tone_map(image, bands);
  EXPECT_GT(bytes[5], bytes[3]);  // short waves: more blue than red
  EXPECT_GT(bytes[6], bytes[8]);  // long waves: more red than blue
}

}  // namespace
}  // namespace lightwell
