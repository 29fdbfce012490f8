#include "scene/io/pictures/picture_mean.h"

#include <gtest/gtest.h>

#include "scene/errors.h"
#include "tests/temporary_folder.h"

namespace lightwell::picture_mean_test {
namespace {

const std::filesystem::path folder = LIGHTWELL_TEST_DATA "/scene";

TEST(PictureMean, IsTakenOfLightNotOfItsCode) {
  // A white, opaque pixel and a black, transparent one.
  const auto mean = picture_mean(content_of(folder / "two-pixels.png"), PictureCode::srgb, "it");
  ASSERT_TRUE(mean.has_value());
  EXPECT_DOUBLE_EQ(mean->color[0], 0.5);
  EXPECT_DOUBLE_EQ(mean->covered_color[1], 1.0);
  EXPECT_DOUBLE_EQ(mean->alpha, 0.5);
}

// A grey of 188 of 255: ((188/255 + 0.055) / 1.055)^2.4 = 0.5029. A JPEG decoder may be off by one
// code, a difference of 0.006 there.
TEST(PictureMean, DecodesJpegAndTheSrgbCurve) {
  PictureFiles files;
  const auto mean = files.mean(folder / "grey.jpg", PictureCode::srgb);
  ASSERT_TRUE(mean.has_value());
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(mean->color[c], 0.5029, 0.006);
  const auto raw = files.mean(folder / "grey.jpg", PictureCode::linear);
  EXPECT_NEAR(raw->color[0], 188.0 / 255.0, 1.0 / 255.0);
}

TEST(PictureMean, SrgbIsLinearBelowItsToe) {
  EXPECT_DOUBLE_EQ(linear_from_srgb(0.0), 0.0);
  EXPECT_DOUBLE_EQ(linear_from_srgb(1.0), 1.0);
  EXPECT_NEAR(linear_from_srgb(0.04045), 0.04045 / 12.92, 1e-12);
  EXPECT_NEAR(linear_from_srgb(0.5), 0.21404114, 1e-8);
}

TEST(PictureMean, IsUnknownForOtherFormats) {
  EXPECT_FALSE(picture_mean("#?RADIANCE\n", PictureCode::linear, "it").has_value());
  EXPECT_FALSE(picture_mean("", PictureCode::srgb, "it").has_value());
}

TEST(PictureMean, DamageAndHugeSizesAreRefusedByName) {
  std::string png = content_of(folder / "two-pixels.png"), jpeg = content_of(folder / "grey.jpg");
  EXPECT_THROW(picture_mean(png.substr(0, 50), PictureCode::srgb, "it"), InputError);
  EXPECT_THROW(picture_mean(jpeg.substr(0, 30), PictureCode::srgb, "it"), InputError);
  const auto frame = jpeg.find("\xff\xc0");  // then length, precision, height and width
  ASSERT_NE(frame, std::string::npos);
  jpeg.replace(frame + 5, 4, "\xea\x60\xea\x60");
  try {
    picture_mean(jpeg, PictureCode::srgb, "picture 'wall'");
    FAIL() << "3.6 gigapixels were accepted";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("picture 'wall' has 60000 x 60000"), std::string::npos)
        << error.what();
  }
}

std::string refusal(const std::string& bytes) {
  try {
    picture_mean(bytes, PictureCode::srgb, "it");
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

// A few bytes that say so would take 12 MB and more.
TEST(PictureMean, AJpegIsNoLargerThanItsBytesAllow) {
  std::string jpeg = content_of(folder / "grey.jpg");
  jpeg.replace(jpeg.find("\xff\xc0") + 5, 4, "\x07\xd0\x07\xd0");
  EXPECT_NE(refusal(jpeg).find("too short for its 2000 x 2000 pixels"), std::string::npos);
}

// The last scan is repeated; each scan costs as much time as the picture.
TEST(PictureMean, AJpegOfVeryManyScansIsRefused) {
  const std::string jpeg = content_of(folder / "progressive.jpg");
  EXPECT_EQ(refusal(jpeg), "");
  const auto scan = jpeg.rfind("\xff\xda"), end = jpeg.rfind("\xff\xd9");
  std::string many = jpeg.substr(0, end);
  for (int i = 0; i < 200; ++i) many += jpeg.substr(scan, end - scan);
  EXPECT_NE(refusal(many + jpeg.substr(end)).find("more than 100 scans"), std::string::npos);
}

}  // namespace
}  // namespace lightwell::picture_mean_test
