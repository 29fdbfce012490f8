#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "raytrace/display/display.h"
#include "raytrace/pictures/image.h"
#include "scene/sampling.h"

namespace lightwell::tone_map_test {
namespace {

Image flat_image(int width, int height, const Eigen::Array3f& L) {
  Image image{.width = width, .height = height};
  image.radiance = L.transpose().replicate(width * height, 1);
  return image;
}

constexpr std::array all_curves = {ToneCurve::shoulder, ToneCurve::linear, ToneCurve::reinhard,
                                   ToneCurve::filmic};

// A wall whose luminance varies by a factor of 16, as in rooms.
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
  EXPECT_NEAR((shoulder(0.5f + h) - shoulder(0.5f)) / h, 1.0f, 2 * h);  // the slope starts at 1
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
  for (const ToneCurve curve : all_curves) {
    for (const bool automatic : {true, false}) {
      const auto bytes = tone_map(image, rgb_bands(), {.automatic = automatic, .curve = curve});
      EXPECT_TRUE(std::is_sorted(bytes.begin(), bytes.end()));
      EXPECT_EQ(bytes.back(), 255);
    }
  }
}

TEST(ToneMap, NeutralGreysStayNeutral) {
  for (const ToneCurve curve : all_curves) {
    const auto bytes = tone_map(wall(256), rgb_bands(), {.curve = curve});
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
      EXPECT_EQ(bytes[i], bytes[i + 1]);
      EXPECT_EQ(bytes[i], bytes[i + 2]);
    }
  }
}

TEST(ToneMap, ExposureValueMakesOnePointTwoTimesTwoToTheEvWhite) {
  // ISO 12232: L = 78 / (0.65 * 100) 2^EV = 1.2 * 2^EV; EV 10 is 1228.8 cd/m^2. A surface of that
  // luminance has the radiance 1228.8 / 683 in every band.
  EXPECT_DOUBLE_EQ(luminance_of_white(10), 1228.8);
  const auto L = static_cast<float>(1228.8 / 683);
  const ToneMapping photo{.ev100 = 10.0, .curve = ToneCurve::linear};
  const Image half_white = flat_image(1, 1, Eigen::Array3f::Constant(0.5f * L));
  EXPECT_NEAR(L * exposure_scale(half_white, rgb_bands(), photo), 1.0, 1e-6);
  EXPECT_EQ(tone_map(half_white, rgb_bands(), photo)[0], 188);  // sRGB of 0.5
  // The scale depends neither on other pixels nor on lumens per watt.
  Image lamp = flat_image(2, 1, Eigen::Array3f::Constant(0.5f * L));
  lamp.radiance.row(1) = 1e4f;
  EXPECT_EQ(tone_map(lamp, rgb_bands(), photo)[0], 188);
  EXPECT_NEAR(exposure_scale(lamp, rgb_bands(179), photo) * 683,
              179 * exposure_scale(lamp, rgb_bands(), photo), 1e-9);
  ToneMapping brighter = photo;
  brighter.exposure_ev = 1.0;
  EXPECT_EQ(tone_map(half_white, rgb_bands(), brighter)[0], 255);
}

TEST(ToneMap, ExposureValueOfAScaleIsTheInverseOfItsScale) {
  const Image image = wall(8);
  for (const double ev : {-3.0, 0.0, 12.5}) {
    const double scale = exposure_scale(image, rgb_bands(179), {.ev100 = ev});
    EXPECT_NEAR(ev100_of_scale(scale, rgb_bands(179)), ev, 1e-12);
  }
}

TEST(ToneCurves, PassThroughTheirPublishedPoints) {
  const auto shown = [](float x, ToneCurve curve) {
    return display_rgb(Eigen::Array3f::Constant(x), 1.0, curve)[0];
  };
  // Equation 4 with a white of 4: x (1 + x / 16) / (1 + x); 1 at x = 4.
  EXPECT_NEAR(shown(1.0f, ToneCurve::reinhard), 1.0625 / 2, 1e-6);
  EXPECT_NEAR(shown(4.0f, ToneCurve::reinhard), 1.0, 1e-6);
  // Hable's curve at 2 x = 2: (2 (0.3 + 0.05) + 0.004) / (2 (0.3 + 0.5) + 0.06) - 1/15, over
  // its value at 11.2, (11.2 (1.68 + 0.05) + 0.004) / (11.2 (1.68 + 0.5) + 0.06) - 1/15.
  EXPECT_NEAR(shown(1.0f, ToneCurve::filmic),
              (0.704 / 1.66 - 1.0 / 15) / (19.38 / 24.476 - 1.0 / 15), 1e-5);
  EXPECT_NEAR(shown(5.6f, ToneCurve::filmic), 1.0, 1e-6);
  EXPECT_NEAR(shown(0.0f, ToneCurve::filmic), 0.0f, 1e-7);
  EXPECT_EQ(shown(0.3f, ToneCurve::linear), 0.3f);
  EXPECT_EQ(shown(7.0f, ToneCurve::linear), 1.0f);
}

TEST(ToneCurves, ReinhardKeepsTheRatiosOfColours) {
  const Eigen::Array3f shown = display_rgb({0.4f, 0.2f, 0.1f}, 1.0, ToneCurve::reinhard);
  EXPECT_NEAR(shown[0] / shown[1], 2.0, 1e-5);
  EXPECT_NEAR(shown[1] / shown[2], 2.0, 1e-5);
}

TEST(ToneMap, ExposureDoesNotDependOnTheUnitOfRadiance) {
  Image image = wall(256);
  const auto bytes = tone_map(image, rgb_bands());
  image.radiance *= 1024.0f;  // a power of two: no rounding
  EXPECT_EQ(tone_map(image, rgb_bands()), bytes);
}

// The key of the automatic exposure (docs/tone-mapping.md).
TEST(ToneMap, TypicalLuminanceIsAFifthOfWhite) {
  for (const float L : {0.01f, 1.0f, 300.0f}) {
    const Image image = flat_image(4, 3, {L, L, L});
    EXPECT_NEAR(L * exposure_scale(image, rgb_bands()), 0.2, 1e-6);  // float radiance
  }
}

TEST(ToneMap, LampsAndBlackDoNotMoveTheExposure) {
  const double without = exposure_scale(wall(1000), rgb_bands());
  Image image{.width = 1300, .height = 1};
  image.radiance.setZero(1300, 3);  // 200 pixels of black outside
  image.radiance.topRows(1000) = wall(1000).radiance;
  image.radiance.middleRows(1000, 100) = 1e4f;  // and a lamp
  // The median moves by at most 100 ranks of 1000, 0.4 stops, but the mean over the wall stays.
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
                              {.exposure_ev = 1.0, .automatic = false, .curve = ToneCurve::linear});
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
  // Columns are wall, 30 % lamp, and lamp. The linear mix is 0.3 of the lamp's white plus 0.7 of
  // the wall's.
  Image image{.width = 101, .height = 3};
  image.radiance.setConstant(303, 3, 1.0f);
  for (int y = 0; y < 3; ++y) {
    image.radiance.row(101 * y + 99) = 0.3f * 500.0f + 0.7f * 1.0f;
    image.radiance.row(101 * y + 100) = 500.0f;
  }
  const auto bytes = tone_map(image, rgb_bands());
  const float wall = shoulder(static_cast<float>(exposure_scale(image, rgb_bands())));
  const float expected = 255.0f * srgb_encode(0.3f + 0.7f * wall);
  EXPECT_NEAR(bytes[3 * (101 + 99)], expected, 1.0);  // the lamp is slightly below 1
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
}  // namespace lightwell::tone_map_test
