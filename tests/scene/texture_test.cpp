#include "scene/texture.h"

#include <gtest/gtest.h>

#include <cmath>

#include "scene/sampling.h"

namespace lightwell::texture_test {
namespace {

// Half a step of the code at a share s, where steps are 2 sqrt(s) / 65535, plus float rounding.
float step_at(float share) {
  return std::sqrt(share) / 65535.0f + 1e-7f;
}

Texture random_texture(int width, int height, int channels) {
  std::vector<Texture::Code> texels;
  const int count = width * height * channels;
  for (int i = 0; i < count; ++i) {
    texels.push_back(Texture::encode(
        static_cast<float>(random_uniform(random_key(7, static_cast<std::uint64_t>(i))))));
  }
  return {width, height, channels, std::move(texels)};
}

// A texture with black top left, white top right, and grey 0.25 and 0.5 below.
SurfaceTexture four_texels() {
  std::vector<Texture::Code> texels;
  for (const float share : {0.0f, 1.0f, 0.25f, 0.5f}) texels.push_back(Texture::encode(share));
  return {.picture = std::make_shared<const Texture>(2, 2, 1, std::move(texels))};
}

TEST(Texture, CodesKeepSharesToHalfAStep) {
  for (const float share : {0.0f, 1e-4f, 0.01f, 0.2f, 0.7f, 1.0f}) {
    EXPECT_NEAR(Texture::decode(Texture::encode(share)), share, step_at(share));
  }
  EXPECT_EQ(Texture::decode(Texture::encode(-1.0f)), 0.0f);
  EXPECT_EQ(Texture::decode(Texture::encode(std::nanf(""))), 0.0f);
  EXPECT_EQ(Texture::decode(Texture::encode(7.0f)), 1.0f);
}

TEST(Texture, EveryLevelHasTheMeanOfThePicture) {
  for (const auto& [width, height] : {std::pair(8, 8), {5, 3}, {1, 7}, {37, 2}}) {
    const Texture picture = random_texture(width, height, 3);
    for (int level = 0; level < picture.level_count(); ++level) {
      const int w = picture.level_width(level), h = picture.level_height(level);
      Eigen::Array3d sum = Eigen::Array3d::Zero();
      for (int y = 0; y < h; ++y) {
        for (int x = 0; x < w; ++x) sum += picture.texel(level, x, y).cast<double>();
      }
      // Each level has a rounding error of at most half a step.
      const double off = (sum / (w * h) - picture.mean().cast<double>()).abs().maxCoeff();
      EXPECT_LE(off, (level + 1) * step_at(1.0f)) << width << " x " << height << ", " << level;
    }
    EXPECT_EQ(picture.level_width(picture.level_count() - 1), 1);
  }
}

TEST(Texture, PlacesAreCountedFromTheTopLeftCorner) {
  SurfaceTexture image = four_texels();
  image.is_smooth = false;
  EXPECT_NEAR(image.at({0.1, 0.1})[0], 0.0f, step_at(1.0f));
  EXPECT_NEAR(image.at({0.9, 0.1})[1], 1.0f, step_at(1.0f));
  EXPECT_NEAR(image.at({0.1, 0.9})[2], 0.25f, step_at(1.0f));
  EXPECT_NEAR(image.at({0.9, 0.9})[0], 0.5f, step_at(1.0f));
}

TEST(Texture, IsLinearBetweenTheMiddlesOfTexels) {
  const SurfaceTexture image = four_texels();
  EXPECT_NEAR(image.at({0.5, 0.25})[0], 0.5f, step_at(1.0f));
  EXPECT_NEAR(image.at({0.25, 0.5})[0], 0.125f, step_at(1.0f));
  EXPECT_NEAR(image.at({0.5, 0.5})[0], 1.75f / 4.0f, step_at(1.0f));
}

TEST(Texture, GoesOnBeyondItsEdgesAsItsWrapSays) {
  SurfaceTexture image = four_texels();
  image.is_smooth = false;
  const auto top_row_at = [&](TextureWrap wrap, double u) {
    image.wrap.fill(wrap);
    return image.at({u, 0.1})[0];
  };
  EXPECT_NEAR(top_row_at(TextureWrap::repeat, 1.1), 0.0f, step_at(1.0f));
  EXPECT_NEAR(top_row_at(TextureWrap::repeat, -0.1), 1.0f, step_at(1.0f));
  EXPECT_NEAR(top_row_at(TextureWrap::mirror, 1.1), 1.0f, step_at(1.0f));
  EXPECT_NEAR(top_row_at(TextureWrap::mirror, -0.1), 0.0f, step_at(1.0f));
  EXPECT_NEAR(top_row_at(TextureWrap::clamp, 17.0), 1.0f, step_at(1.0f));
  EXPECT_NEAR(top_row_at(TextureWrap::clamp, -3.0), 0.0f, step_at(1.0f));
  // Coordinates beyond the range of integers, and NaN, still give a texel of the picture.
  for (const double u : {1e300, -1e300, std::nan(""), HUGE_VAL}) {
    for (const auto wrap : {TextureWrap::repeat, TextureWrap::mirror, TextureWrap::clamp}) {
      const float share = top_row_at(wrap, u);
      EXPECT_TRUE(share >= 0.0f && share <= 1.0f) << u;
    }
  }
}

TEST(Texture, AFootprintAsLargeAsThePictureSeesItsMean) {
  const SurfaceTexture image{.picture = std::make_shared<const Texture>(random_texture(16, 16, 3))};
  const Eigen::Array3f mean = image.picture->mean();
  for (int i = 0; i < 20; ++i) {
    const Eigen::Vector2d uv(random_uniform(random_key(1, i)), random_uniform(random_key(2, i)));
    const Eigen::Array3f seen = image.over(uv, Eigen::Matrix2d::Identity());
    EXPECT_LT((seen - mean).abs().maxCoeff(), 5 * step_at(1.0f));  // of five levels
  }
}

// A footprint as long as the picture and narrow across has the mean of a row or of a column. It is
// filtered on a mip level of one texel, without blur across.
TEST(Texture, ALongFootprintIsNotBlurredAcross) {
  std::vector<Texture::Code> texels;
  for (int y = 0; y < 8; ++y) {
    for (int x = 0; x < 8; ++x) texels.push_back(Texture::encode(y < 4 ? 1.0f : 0.0f));
  }
  const SurfaceTexture image{.picture = std::make_shared<const Texture>(8, 8, 1, texels)};
  Eigen::Matrix2d along;
  along << 1.0, 0.0, 0.0, 0.01;
  EXPECT_NEAR(image.over({0.5, 0.25}, along)[0], 1.0f, step_at(1.0f));
  EXPECT_NEAR(image.over({0.5, 0.75}, along)[0], 0.0f, step_at(1.0f));
}

TEST(Texture, ThePlacementScalesAndMovesIt) {
  SurfaceTexture image = four_texels();
  image.is_smooth = false;
  image.placement << 0.5, 0.0, 0.5, 0.0, 0.5, 0.0;  // the top right quarter over all of (u, v)
  EXPECT_NEAR(image.at({0.9, 0.9})[0], 1.0f, step_at(1.0f));
  EXPECT_NEAR(image.over({0.5, 0.5}, 0.1 * Eigen::Matrix2d::Identity())[0], 1.0f, step_at(1.0f));
}

TEST(Texture, EqualPicturesHaveEqualHashes) {
  EXPECT_EQ(random_texture(8, 4, 3).hash(), random_texture(8, 4, 3).hash());
  EXPECT_NE(random_texture(8, 4, 3).hash(), random_texture(4, 8, 3).hash());
  const Texture picture = random_texture(8, 4, 3);
  const Texture darker =
      picture.mapped([](const Eigen::Array3f& texel) -> Eigen::Array3f { return 0.5f * texel; });
  EXPECT_NE(picture.hash(), darker.hash());
  EXPECT_LT((darker.mean() - 0.5f * picture.mean()).abs().maxCoeff(), 2 * step_at(1.0f));
}

TEST(Texture, TexelsMustFillIt) {
  EXPECT_THROW(Texture(2, 2, 1, std::vector<Texture::Code>(3)), std::invalid_argument);
  EXPECT_THROW(Texture(2, 2, 2, std::vector<Texture::Code>(8)), std::invalid_argument);
  EXPECT_THROW(Texture(0, 2, 1, {}), std::invalid_argument);
}

}  // namespace
}  // namespace lightwell::texture_test
