// Textures in pictures.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "radiosity/emitters/emitter.h"
#include "raytrace/pictures/layers.h"
#include "scene/parallel.h"
#include "tests/pictures.h"
#include "tests/raytrace/lit_scene.h"

namespace lightwell::textures_test {
namespace {

constexpr auto pi_f = std::numbers::pi_v<float>;
// Relative error of 16-bit texels between 0.1 and 1, with float sums.
constexpr float rounding = 1e-4f;

// A unit square in the plane z = 0 with u along x and v along -y, and a camera above whose picture
// it fills: row 0 is at y = 1.
Scene square(const SurfaceTexture& picture) {
  Scene scene = SceneBuilder().polygon({}, {{0, 1, 0}, {0, 0, 0}, {1, 0, 0}, {1, 1, 0}}).build();
  put_picture(scene, 0, picture);
  UvMap map;
  map.gradient << 1, 0, 0, 0, -1, 0;
  map.offset << 0, 1;
  std::get<PolygonMesh>(scene.surfaces[0].shape).uv_maps = {map};
  return scene;
}

Camera from_above(int pixels) {
  return {.name = "above",
          .position = {0.5, 0.5, 100},
          .direction = {0, 0, -1},
          .up = {0, 1, 0},
          .fov_degrees = 2.0 * std::atan(0.005) * 180.0 / std::numbers::pi,
          .width = pixels,
          .height = pixels};
}

std::vector<float> noise(int count) {
  std::vector<float> shares;
  for (int i = 0; i < count; ++i) {
    shares.push_back(0.1f + 0.9f * static_cast<float>((i * 61) % 97) / 96.0f);
  }
  return shares;
}

class InEveryPass : public testing::TestWithParam<Pass> {};

// A texel is eight pixels wide: inner pixels show the texel alone.
TEST_P(InEveryPass, APixelShowsTextureTimesIrradianceOverPi) {
  constexpr int texels = 8, pixels = 64;
  constexpr float E = 3.0f;
  const std::vector<float> shares = noise(texels * texels);
  TracedScene lit(square(picture_of(texels, texels, shares)), 0.2);
  // The scene has no emitter: its only light is the irradiance of the mesh.
  if (GetParam() == Pass::gather) GTEST_SKIP() << "there is nothing to gather from";
  lit.set_indirect([](const auto&) { return E; });
  const Image image = lit.render(from_above(pixels), {.pass = GetParam()});
  for (int y = 0; y < pixels; ++y) {
    for (int x = 0; x < pixels; ++x) {
      if (x % 8 == 0 || x % 8 == 7 || y % 8 == 0 || y % 8 == 7) continue;  // edges of texels
      const float rho = shares[static_cast<std::size_t>(texels * (y / 8) + x / 8)];
      EXPECT_NEAR(image.radiance(pixels * y + x, 1), rho * E / pi_f, rounding * E);
    }
  }
}
INSTANTIATE_TEST_SUITE_P(Passes, InEveryPass, testing::Values(Pass::interpolate, Pass::direct));

// Black walls that emit M give E = M on a square between them, whose radiance is texel times E /
// pi.
TEST(Textures, AFinalGatherShowsTheTextureToo) {
  constexpr float E = 3.0f;
  Scene scene = SceneBuilder()
                    .polygon({}, {{0, 1, 0}, {0, 0, 0}, {1, 0, 0}, {1, 1, 0}})
                    .box({.exitance = E, .one_sided = true}, {-1, -1, -1}, {2, 2, 200}, true)
                    .build();
  SurfaceTexture halves = picture_of(2, 1, {0.2f, 0.8f});
  halves.wrap.fill(TextureWrap::clamp);  // samples lie on the square's very edge
  put_picture(scene, 0, halves);
  TracedScene lit(std::move(scene), 20.0);
  ASSERT_TRUE(lit.direct_light.emitters().empty());
  Camera camera = from_above(8);
  const Image image = lit.render(camera, {.pass = Pass::gather, .gather_rays = 64});
  // lay_uv runs u along y and v along x there: the first texel is at large y.
  for (int y = 0; y < 8; ++y) {
    if (y == 3 || y == 4) continue;
    for (int x = 0; x < 8; ++x) {
      EXPECT_NEAR(image.radiance(8 * y + x, 0), (y < 4 ? 0.2f : 0.8f) * E / pi_f, rounding * E)
          << x << ", " << y;
    }
  }
}

// A picture of light is seen as M / pi of each texel, straight and in a mirror, in every pass.
TEST_P(InEveryPass, APixelShowsThePictureOfLight) {
  constexpr int texels = 8, pixels = 64;
  constexpr float M = 3.0f;
  const std::vector<float> shares = noise(texels * texels);
  Scene scene =
      SceneBuilder()
          .polygon({}, {{0, 1, 0}, {0, 0, 0}, {1, 0, 0}, {1, 1, 0}})
          .polygon({.specular = 0.5f}, {{0, 0, 200}, {0, 1, 200}, {1, 1, 200}, {1, 0, 200}})
          .build();
  put_light(scene, 0, picture_of(texels, texels, shares), M);
  UvMap map;
  map.gradient << 1, 0, 0, 0, -1, 0;
  map.offset << 0, 1;
  std::get<PolygonMesh>(scene.surfaces[0].shape).uv_maps = {map};
  TracedScene lit(std::move(scene), 0.2);
  const auto expect_texels = [&](const Camera& camera, float share, bool is_mirrored) {
    const Image image = lit.render(camera, {.pass = GetParam(), .gather_rays = 4});
    for (int y = 0; y < pixels; ++y) {
      for (int x = 0; x < pixels; ++x) {
        if (x % 8 == 0 || x % 8 == 7 || y % 8 == 0 || y % 8 == 7) continue;  // edges of texels
        const int column = is_mirrored ? texels - 1 - x / 8 : x / 8;
        const float M_here = M * shares[static_cast<std::size_t>(texels * (y / 8) + column)];
        EXPECT_NEAR(image.radiance(pixels * y + x, 1), share * M_here / pi_f, rounding * M);
      }
    }
  };
  expect_texels(from_above(pixels), 1.0f, false);
  // From the screen's height upwards, its image in the mirror is 300 m away.
  Camera up = from_above(pixels);
  up.direction = {0, 0, 1};
  up.fov_degrees = 2.0 * std::atan(0.5 / 300.0) * 180.0 / std::numbers::pi;
  expect_texels(up, 0.5f, true);
}

// Texels are 16 times finer than pixels. A filtered pixel is the mean over its footprint and as
// much around; samples of unfiltered texels at its corners would have the texels' standard
// deviation of 0.26. The mean of 256 independent texels has 0.26 / 16.
TEST(Textures, FineTexturesDoNotShimmer) {
  constexpr int texels = 512, pixels = 32;
  TracedScene lit(square(picture_of(texels, texels, noise(texels * texels))), 0.2);
  lit.set_indirect([](const auto&) { return pi_f; });
  const Image image = lit.render(from_above(pixels), {.pass = Pass::interpolate});
  const float mean = image.radiance.col(0).mean();
  const float spread = std::sqrt((image.radiance.col(0) - mean).square().mean());
  EXPECT_NEAR(mean, 0.55f, 0.26f / 16.0f / pixels * 3.0f + 1e-3f);
  EXPECT_LT(spread, 0.26f / 16.0f);
}

TEST(Textures, TheAlbedoLayerIsTheTexture) {
  TracedScene lit(square(picture_of(2, 2, {0.1f, 0.4f, 0.7f, 1.0f})), 0.2);
  const Image image = lit.render(from_above(8), {.layers = {Layer::albedo, Layer::indirect}});
  const auto albedo = [&](int x, int y) { return image.layers.values(8 * y + x, 0); };
  EXPECT_NEAR(albedo(1, 1), 0.1f, rounding);
  EXPECT_NEAR(albedo(6, 1), 0.4f, rounding);
  EXPECT_NEAR(albedo(1, 6), 0.7f, rounding);
  EXPECT_NEAR(albedo(6, 6), 1.0f, rounding);
}

// Rows of the mask are strips; a bright floor is visible through the holes.
TEST(Textures, TheEyeSeesThroughHoles) {
  Scene scene = SceneBuilder()
                    .polygon({}, {{0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}})
                    .polygon({.exitance = pi_f}, {{-1, -1, 0}, {2, -1, 0}, {2, 2, 0}, {-1, 2, 0}})
                    .build();
  put_mask(scene, 0, picture_of(4, 1, {1, 0, 0, 1}));
  const TracedScene lit(std::move(scene), 0.5);
  const Image image = lit.render(from_above(32), {.pass = Pass::interpolate});
  for (int x = 0; x < 32; ++x) {
    if (x % 8 == 0 || x % 8 == 7) continue;
    EXPECT_FLOAT_EQ(image.radiance(32 * 16 + x, 0), x / 8 == 1 || x / 8 == 2 ? 1.0f : 0.0f) << x;
  }
}

TEST(Textures, BitsOfAPictureDoNotDependOnTheNumberOfThreads) {
  const auto rendered = [&](int threads) {
    const ThreadLimit limit(threads);
    TracedScene lit(square(picture_of(32, 32, noise(32 * 32))), 0.2);
    lit.set_indirect([](const Eigen::Vector3d& p) { return static_cast<float>(1.0 + p.x()); });
    return lit.render(from_above(40)).radiance;
  };
  const BandArray one = rendered(1);
  EXPECT_TRUE((one == rendered(2)).all());
  EXPECT_TRUE((one == rendered(3)).all());
}

}  // namespace
}  // namespace lightwell::textures_test
