// Relief in pictures: direction and mean of its light, furnaces, no light from behind, far views.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "tests/pictures.h"
#include "tests/raytrace/lit_scene.h"

namespace lightwell::relief_picture_test {
namespace {

using Eigen::Vector3d;

constexpr auto pi_f = std::numbers::pi_v<float>;

// Waves of `count` periods along the picture, 1/16 high at a slope of 1.
SurfaceTexture waves(int count) {
  constexpr int texels = 512;
  std::vector<float> shares;
  for (int i = 0; i < texels; ++i) {
    const double phase = 2.0 * std::numbers::pi * count * (i + 0.5) / texels;
    shares.push_back(static_cast<float>(0.5 + 0.5 * std::sin(phase)));
  }
  SurfaceTexture image = picture_of(texels, 1, shares);
  image.is_smooth = true;
  return image;
}

// A picture of one slope that leans towards +x of wall().
Relief lean(double slope) {
  // Normals (-rise, 0, 1), of which the picture has the direction.
  const double length = std::hypot(slope, 1.0);
  const auto share = [](double part) {
    const double code = 127.5 + std::copysign(0.5 + 127.0 * std::abs(part), part);
    return Texture::encode(static_cast<float>(code / 255.0));
  };
  std::vector<Texture::Code> texels = {share(slope / length), share(0.0), share(1.0 / length)};
  return relief_of_normals({.picture = std::make_shared<const Texture>(1, 1, 3, std::move(texels))},
                           1.0);
}

// A unit square in the plane z = 0 that faces +z, with the picture's right along x.
void add_wall(Scene& scene, const Paint& paint, const std::optional<Relief>& relief) {
  const Scene other =
      SceneBuilder().polygon(paint, {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}).build();
  Surface wall = other.surfaces[0];
  wall.name = "wall";
  wall.material = static_cast<int>(scene.materials.size());
  lay_uv(wall);
  scene.surfaces.push_back(wall);
  scene.materials.push_back(other.materials[0]);
  scene.materials.back().relief = relief;
}

Scene lit_from(const Vector3d& lamp, const Paint& paint, const std::optional<Relief>& relief) {
  const Vector3d middle(0.5, 0.5, 0);
  Scene scene = SceneBuilder()
                    .square({.exitance = 1e4f, .one_sided = true}, middle + lamp, -lamp, 0.1)
                    .build();
  add_wall(scene, paint, relief);
  return scene;
}

Camera above(double height, int pixels) {
  Camera camera = camera_towards({0.5, 0.5, height}, {0.5, 0.5, 0}, 1.0, pixels);
  camera.up = Vector3d::UnitY();
  camera.fov_degrees = 2.0 * std::atan(0.5 / height) * 180.0 / std::numbers::pi;
  return camera;
}

Image picture(const Scene& scene, const Camera& camera, const RenderOptions& options = {}) {
  const TracedScene lit(scene);
  return lit.render(camera, options);
}

const Paint white{.reflectance = 1.0f};

// g = 1 + slope tan(theta) towards a lamp at the angle theta to the normal; the lamp is 0.2 m wide
// at 20 m, so its directions differ by 0.01, and the wall's points see it by up to 0.025 rad apart.
TEST(ReliefInPictures, SlopesFaceLampsOrNot) {
  constexpr double slope = 0.5;
  for (const double tangent : {-1.0, 0.0, 1.0, 3.0}) {
    const Vector3d lamp = 20.0 * Vector3d(tangent, 0, 1).normalized();
    const Eigen::ArrayXf flat = picture(lit_from(lamp, white, {}), above(40, 8)).radiance.col(0);
    const Eigen::ArrayXf bent =
        picture(lit_from(lamp, white, lean(slope)), above(40, 8)).radiance.col(0);
    const double expected = std::clamp(1.0 + slope * tangent, 0.0, 2.0);
    // A change of the angle by 0.03 changes the tangent by 0.03 (1 + tangent^2).
    const double off = slope * 0.03 * (1.0 + tangent * tangent);
    EXPECT_NEAR((bent / flat).minCoeff(), expected, off) << tangent;
    EXPECT_NEAR((bent / flat).maxCoeff(), expected, off) << tangent;
  }
}

TEST(ReliefInPictures, SeenFromBehindARiseIsAHollow) {
  const Vector3d lamp = 20.0 * Vector3d(1, 0, -1).normalized();
  Camera below = above(40, 8);
  below.position.z() = -40;
  below.direction = Vector3d::UnitZ();
  const Eigen::ArrayXf flat = picture(lit_from(lamp, white, {}), below).radiance.col(0);
  const Eigen::ArrayXf bent = picture(lit_from(lamp, white, lean(0.5)), below).radiance.col(0);
  // The front leans towards +x, so the back leans away from +x.
  EXPECT_NEAR((bent / flat).mean(), 0.5, 0.03);
}

// Light at 15 degrees over waves with slopes up to 0.5 at 27 degrees: a part of them is dark. The
// lamp's light falls by about 2 m / 20 m over the wall, so by 1.25 % over one of 8 waves; the
// slopes, odd over a wave, meet that with 1 / (2 pi): 0.2 %. Corners of pixels are 8 to the wave,
// and their means are exact for waves if none is subdivided.
TEST(ReliefInPictures, AWallOfWavesIsAsBrightAsAFlatOne) {
  const double depth = 2.0 * 0.5 / (2.0 * std::numbers::pi * 8.0);
  const Relief relief = relief_of_heights(waves(8), depth, DepthUnit::metre);
  const RenderOptions options{.max_subdivision = 0};
  for (const int degrees : {15, 45, 90}) {
    const double angle = degrees * std::numbers::pi / 180.0;
    const Vector3d lamp = 20.0 * Vector3d(std::cos(angle), 0, std::sin(angle));
    const Eigen::ArrayXf flat =
        picture(lit_from(lamp, white, {}), above(40, 64), options).radiance.col(0);
    const Eigen::ArrayXf wavy =
        picture(lit_from(lamp, white, relief), above(40, 64), options).radiance.col(0);
    RecordProperty(std::to_string(degrees), std::to_string(wavy.mean() / flat.mean()));
    EXPECT_NEAR(wavy.mean() / flat.mean(), 1.0, 2e-3) << degrees;
    if (degrees > 15) continue;
    EXPECT_LT(wavy.minCoeff(), 0.05f * flat.mean()) << "some slopes are dark";
    EXPECT_NEAR(wavy.maxCoeff(), 2.0f * flat.mean(), 0.2f * flat.mean());
  }
}

// Texels are 8 times finer than pixels: waves of two pixels' width fade to the flat wall. The
// widest filter of a pixel averages one to two pixels, over which a wave of a quarter pixel is even
// to the next level of the mip map.
TEST(ReliefInPictures, FromAfarAWallOfWavesIsFlat) {
  const Vector3d lamp = 20.0 * Vector3d(1, 0, 1).normalized();
  const Relief relief = relief_of_heights(waves(64), 0.002, DepthUnit::metre);
  const Eigen::ArrayXf flat = picture(lit_from(lamp, white, {}), above(40, 16)).radiance.col(0);
  const Eigen::ArrayXf far = picture(lit_from(lamp, white, relief), above(40, 16)).radiance.col(0);
  EXPECT_LT((far / flat - 1.0f).abs().maxCoeff(), 0.01f);
  const Eigen::ArrayXf near =
      picture(lit_from(lamp, white, relief), above(40, 512)).radiance.col(0);
  EXPECT_GT(near.maxCoeff() - near.minCoeff(), 0.5f * flat.mean());
}

// Radiance of a wall with relief in a room of constant radiance 1.
Eigen::ArrayXf in_furnace(const Paint& paint, const RenderOptions& options) {
  Scene scene = SceneBuilder().box({.exitance = pi_f}, {-6, -6, -6}, {6, 6, 6}, true).build();
  add_wall(scene, paint, relief_of_heights(waves(4), 0.05, DepthUnit::metre));
  TracedScene lit(scene);
  lit.set_indirect([](const auto&) { return pi_f; });
  Camera camera = camera_towards({-1.5, 0.4, 2}, {0.5, 0.5, 0}, 14, 24);
  return lit.render(camera, options).radiance.col(0);
}

// Every ray has radiance 1, whatever its direction: only float rounding. The mesh's light, which
// has no direction, counts as even. (Glass is a pane: behind the surface of a body, radiance 1 is
// seen as 1 / n^2.)
TEST(ReliefInPictures, FurnaceIsKeptByTheSolutionsLight) {
  const RenderOptions options{.pass = Pass::direct, .photons = 0};
  for (const Paint& paint :
       {white, Paint{.specular = 1.0f}, Paint{.specular = 1.0f, .roughness = 0.3f},
        Paint{.index_of_refraction = 1.5f, .roughness = 0.3f, .thin = true},
        Paint{.index_of_refraction = 1.5f, .thin = true},
        Paint{.reflectance = 0.5f, .translucent = 0.5f}}) {
    const Eigen::ArrayXf L = in_furnace(paint, options);
    EXPECT_NEAR(L.minCoeff(), 1.0f, 4e-6f);
    EXPECT_NEAR(L.maxCoeff(), 1.0f, 4e-6f);
  }
}

// A white base under a coat: Fresnel's share at the bent normal, and the rest from the base.
TEST(ReliefInPictures, FurnaceIsKeptByCoats) {
  Paint lacquer{.coat = 1.5f};
  Scene coated = SceneBuilder().square(lacquer, {0, 0, 0}, {0, 0, 1}, 1).build();
  lacquer.reflectance = 1.0f - mean_mirrored(coated.materials[0])[0];
  const Eigen::ArrayXf L = in_furnace(lacquer, {.pass = Pass::direct, .photons = 0});
  EXPECT_NEAR(L.minCoeff(), 1.0f, 1e-5f);
  EXPECT_NEAR(L.maxCoeff(), 1.0f, 1e-5f);
}

// Gathered light has the gain of each ray. With slopes s up to 0.63 a ray at the angle theta has a
// gain of 1 + s tan(theta) cos(phi), limited to 0 and 2: its variance is below 0.2. Independent
// sets of 256 rays would leave an error of 0.45 / 16 = 0.03 of a pixel, stratified ones leave less,
// and 576 pixels a twentieth of it.
TEST(ReliefInPictures, FurnaceIsKeptByGatheredLightInTheMean) {
  const Eigen::ArrayXf L =
      in_furnace(white, {.pass = Pass::gather, .gather_rays = 256, .photons = 0});
  EXPECT_NEAR(L.mean(), 1.0f, 3.0f * 0.03f / 24.0f);
  EXPECT_LT((L - 1.0f).square().mean(), 0.03f * 0.03f);
}

// A black screen to the left of the wall leaves light of the right half of a room, for which slopes
// to the right and to the left differ by some 0.6. The mesh's light has a slant of 128 rays for
// each element, of which four share a vertex: 0.5 / sqrt(512) = 0.02 times a slope of 0.3; the
// gather's light has an error of 0.03 / 16 in the mean of 16 x 16 pixels.
TEST(ReliefInPictures, IndirectLightHasADirectionToo) {
  const auto mean = [](const std::optional<Relief>& relief, Pass pass) {
    Scene scene = SceneBuilder()
                      .box({.exitance = pi_f}, {-6, -6, -6}, {6, 6, 6}, true)
                      .square({}, {-0.05, 0.5, 0}, {1, 0, 0}, 5.9)
                      .build();
    add_wall(scene, white, relief);
    TracedScene lit(scene);
    lit.set_indirect([](const auto&) { return pi_f; });
    return double{lit.render(above(5, 16), {.pass = pass, .gather_rays = 256, .photons = 0})
                      .radiance.col(0)
                      .mean()};
  };
  for (const double slope : {-0.3, 0.3}) {
    const double gathered = mean(lean(slope), Pass::gather) / mean({}, Pass::gather);
    EXPECT_GT(std::abs(gathered - 1.0), 0.1);
    for (const Pass pass : {Pass::direct, Pass::interpolate}) {
      EXPECT_NEAR(mean(lean(slope), pass) / mean({}, pass), gathered, 0.02) << slope;
    }
  }
}

// Under an even sky every slope gets the same: the gain is a mean over the first rays of the dome,
// at least 16, of the same variance as above; 4096 pixels with rays of their own.
TEST(ReliefInPictures, AnEvenSkyShowsNoReliefInTheMean) {
  Scene scene;
  scene.bands = rgb_bands();
  const Spectrum even = constant_spectrum(scene.bands, 1.0f);
  scene.sky =
      Sky{.up = Vector3d::UnitZ(), .north = Vector3d::UnitY(), .scale = even, .ground = even};
  add_wall(scene, white, relief_of_heights(waves(4), 0.05, DepthUnit::metre));
  const Eigen::ArrayXf L = picture(scene, above(40, 64), {.pass = Pass::direct}).radiance.col(0);
  EXPECT_NEAR(L.mean(), 1.0f, 3.0f * 0.45f / 4.0f / 64.0f);
}

// The steepest slopes face a lamp behind the sheet; nothing comes through, by any kind of surface.
TEST(ReliefInPictures, NoLightComesThroughASheet) {
  const Vector3d lamp = 20.0 * Vector3d(1, 0, -0.1).normalized();
  for (const Paint& paint :
       {white, Paint{.specular = 1.0f}, Paint{.specular = 1.0f, .roughness = 0.5f},
        Paint{.reflectance = 0.5f, .coat = 1.5f}}) {
    for (const double slope : {-4.0, 4.0}) {
      const Scene scene = lit_from(lamp, paint, lean(slope));
      for (const double height : {1.0, 40.0}) {
        EXPECT_EQ(picture(scene, above(height, 8)).radiance.maxCoeff(), 0.0f);
      }
      const Camera grazing = camera_towards({0.5, -3, 0.3}, {0.5, 0.5, 0}, 8, 8);
      EXPECT_EQ(picture(scene, grazing).radiance.maxCoeff(), 0.0f);
    }
  }
}

// A mirror that leans by a slope of tan(22.5 degrees) shows what lies at 45 degrees.
TEST(ReliefInPictures, MirrorsReflectByTheBentNormal) {
  Scene scene =
      SceneBuilder()
          .square({.exitance = pi_f, .one_sided = true}, {10.5, 0.5, 10}, {-1, 0, -1}, 3.0)
          .build();
  add_wall(scene, {.specular = 1.0f}, lean(std::tan(std::numbers::pi / 8.0)));
  EXPECT_FLOAT_EQ(picture(scene, above(40, 4)).radiance.minCoeff(), 1.0f);
  scene.materials.back().relief.reset();
  EXPECT_EQ(picture(scene, above(40, 4)).radiance.maxCoeff(), 0.0f);
}

// Lux on the wall are those of the wall without its relief.
TEST(ReliefInPictures, IlluminanceIsThatOfTheFacet) {
  const Vector3d lamp = 20.0 * Vector3d(1, 0, 1).normalized();
  const RenderOptions options{.layers = {Layer::illuminance}};
  const Image flat = picture(lit_from(lamp, white, {}), above(40, 8), options);
  const Image bent = picture(lit_from(lamp, white, lean(0.5)), above(40, 8), options);
  EXPECT_EQ((flat.layers.values - bent.layers.values).abs().maxCoeff(), 0.0f);
  EXPECT_GT(bent.radiance.mean(), 1.3f * flat.radiance.mean());
}

}  // namespace
}  // namespace lightwell::relief_picture_test
