#include "raytrace/pictures/layers.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "raytrace/render.h"
#include "tests/raytrace/lit_scene.h"

namespace lightwell::layers_test {
namespace {

constexpr auto pi_f = std::numbers::pi_v<float>;

std::vector<Layer> all_layers() {
  std::vector<Layer> all;
  for (const NamedLayer& known : named_layers) all.push_back(known.layer);
  return all;
}

// The columns of one layer, pixels x channels.
BandArray layer(const Image& image, Layer which) {
  const std::vector<std::string> names = channel_names(which);
  const auto& all = image.layers.names;
  const auto first = std::search(all.begin(), all.end(), names.begin(), names.end());
  if (first == all.end()) throw std::invalid_argument("the picture has no such layer");
  return image.layers.values.middleCols(first - all.begin(), std::ssize(names));
}

/// A room with a lamp, a mirroring block, a glass sphere and a lacquered mat.
struct Furnished : TracedScene {
  explicit Furnished(const Bands& bands)
      : TracedScene(SceneBuilder(bands)
                        .box({.reflectance = 0.5f, .one_sided = true}, {0, 0, 0}, {2, 2, 2}, true)
                        .square({.reflectance = 0.2f, .exitance = 10.0f, .one_sided = true},
                                {1, 1.99, 1}, {0, -1, 0}, 0.3)
                        .box({.reflectance = 0.3f, .specular = 0.4f, .one_sided = true},
                             {0.3, 0, 1.2}, {0.8, 1, 1.6}, false)
                        .sphere({.index_of_refraction = 1.5f}, {1.4, 0.4, 0.9}, 0.4)
                        .square({.reflectance = 0.3f, .roughness = 0.2f, .coat = 1.5f},
                                {1, 0.01, 0.6}, {0, 1, 0}, 0.5)
                        .build()) {
    set_direct([](const Eigen::Vector3d& p) { return static_cast<float>(1.0 - 0.2 * p.y()); });
    set_indirect([](const Eigen::Vector3d& p) { return static_cast<float>(0.2 + 0.1 * p.y()); });
  }
};

const Camera door = camera_towards({1, 1, 0.05}, {1, 1.2, 2}, 80, 40);

class LightLayers : public testing::TestWithParam<std::tuple<Pass, int>> {};

TEST_P(LightLayers, AddUpToThePictureInEveryPixel) {
  const auto [pass, band_count] = GetParam();
  const Bands bands = band_count == 3 ? rgb_bands() : spectral_bands(400, 700, band_count);
  const Furnished lit(bands);
  const Image image = lit.render(door, {.pass = pass, .layers = all_layers()});
  BandArray sum = BandArray::Zero(image.radiance.rows(), 3);
  for (const Layer part : {Layer::direct, Layer::indirect, Layer::specular, Layer::emission}) {
    const BandArray light = layer(image, part);
    EXPECT_GT(light.abs().maxCoeff(), 0.0f) << named(part).name;
    sum += light;
  }
  for (Eigen::Index i = 0; i < sum.rows(); ++i) {
    const Spectrum L = image.radiance.row(i).transpose();
    const Eigen::Array3f rgb = linear_rgb(bands, L);
    // Some 200 float sums per pixel; the channels that make up the RGB add up to at most four times
    // its largest value.
    const float rounding = 200 * 6e-8f * 4 * rgb.abs().maxCoeff();
    EXPECT_LE((sum.row(i).transpose() - rgb).abs().maxCoeff(), rounding + 1e-7f) << i;
  }
}

INSTANTIATE_TEST_SUITE_P(PassesAndBands, LightLayers,
                         testing::Combine(testing::Values(Pass::interpolate, Pass::direct),
                                          testing::Values(3, 7)));

TEST(Layers, LeaveThePictureAsItIs) {
  const Furnished lit(rgb_bands());
  const Image with = lit.render(door, {.layers = all_layers()});
  const Image without = lit.render(door);
  EXPECT_TRUE((with.radiance == without.radiance).all());
  EXPECT_TRUE(without.layers.is_empty());
  EXPECT_EQ(with.layers.names.size(), 23u);
}

TEST(Layers, AreInTheOrderOfTheListWhateverOrderTheyAreAskedIn) {
  const Furnished lit(rgb_bands());
  const Image image =
      lit.render(door, {.layers = {Layer::patch, Layer::normal, Layer::depth, Layer::patch}});
  EXPECT_EQ(image.layers.names,
            (std::vector<std::string>{"normal.X", "normal.Y", "normal.Z", "depth.Z", "patch.id"}));
}

TEST(Layers, OfAWallSeenAskew) {
  // z = 0 from (0, 0, 3), 30 degrees off straight down. Depth is measured along the camera's
  // direction d: for a ray r that meets z = 0 at t = 3 / -r.z it is 3 (r.d) / -r.z.
  TracedScene lit(SceneBuilder().square({.reflectance = 0.25f}, {0, 0, 0}, {0, 0, 1}, 50).build());
  lit.set_direct([](const auto&) { return 2.0f; });
  const Camera camera = camera_towards({0, 0, 3}, {std::sqrt(3.0), 0, 0}, 20, 8);
  const Image image = lit.render(camera, {.pass = Pass::interpolate, .layers = all_layers()});
  EXPECT_LT((layer(image, Layer::albedo) - 0.25f).abs().maxCoeff(), 1e-6f);
  EXPECT_LT((layer(image, Layer::direct) - 0.25f * 2.0f / pi_f).abs().maxCoeff(), 1e-6f);
  EXPECT_LT((layer(image, Layer::illuminance) / (683.0f * 2.0f) - 1.0f).abs().maxCoeff(), 1e-5f);
  EXPECT_LT((layer(image, Layer::luminance) / (683.0f * 0.5f / pi_f) - 1.0f).abs().maxCoeff(),
            1e-5f);
  const BandArray normal = layer(image, Layer::normal);
  EXPECT_LT((normal.rowwise() - Eigen::RowVector3f(0, 0, 1).array()).abs().maxCoeff(), 1e-6f);
  const Eigen::Vector3d right = camera.direction.cross(camera.up);
  const double step = 2 * std::tan(10 * std::numbers::pi / 180) / 8;
  const BandArray depth = layer(image, Layer::depth), patch = layer(image, Layer::patch);
  for (int i = 0; i < 64; ++i) {
    const Eigen::Vector3d r = camera.direction + step * (i % 8 - 3.5) * right -
                              step * (i / 8 - 3.5) * camera.up;  // r.d = 1
    EXPECT_NEAR(depth(i, 0), 3 / -r.z(), 1e-5);
    // An element of the patch contains the point at the pixel's centre.
    const Eigen::Vector3d p = camera.position - 3 / r.z() * r;
    ASSERT_EQ(patch(i, 0), std::floor(patch(i, 0)));
    Eigen::AlignedBox3d box;
    for (int e = 0; e < lit.mesh.element_count(); ++e) {
      if (lit.mesh.patch[e] != static_cast<int>(patch(i, 0))) continue;
      for (int c = 0; c < lit.mesh.corner_count(e); ++c) {
        box.extend(lit.mesh.position(lit.mesh.corners[e][c]));
      }
    }
    EXPECT_LT(box.exteriorDistance(p), 1e-4);
  }
}

TEST(Layers, WhereNothingIsDepthIsInfiniteAndThereIsNoPatch) {
  const TracedScene lit(
      SceneBuilder().square({.reflectance = 1}, {0, 0, 0}, {0, 0, 1}, 0.1).build());
  const Image image = lit.render(camera_towards({0, 0, 3}, {0, 0, 0}, 40, 9),
                                 {.pass = Pass::interpolate, .layers = all_layers()});
  EXPECT_EQ(layer(image, Layer::depth)(0, 0), std::numeric_limits<float>::infinity());
  EXPECT_EQ(layer(image, Layer::patch)(0, 0), -1.0f);
  EXPECT_EQ(layer(image, Layer::normal).row(0).abs().maxCoeff(), 0.0f);
  EXPECT_NEAR(layer(image, Layer::depth)(40, 0), 3.0f, 1e-6f);
  EXPECT_GE(layer(image, Layer::patch)(40, 0), 0.0f);
}

TEST(Layers, AlbedoIsAMeanOverThePixel) {
  // The floor is black left of x = 0 and white right of x = 0. The middle one of an odd number of
  // pixel columns is half of each, to the 16 points that sample an edge in each of 4 x 4 cells.
  const TracedScene lit(
      SceneBuilder()
          .polygon({.reflectance = 0.0f}, {{-1, -1, 0}, {0, -1, 0}, {0, 1, 0}, {-1, 1, 0}})
          .polygon({.reflectance = 0.8f}, {{0, -1, 0}, {1, -1, 0}, {1, 1, 0}, {0, 1, 0}})
          .build());
  const Camera camera{.position = {0, 0, 2},
                      .direction = {0, 0, -1},
                      .up = {0, 1, 0},
                      .fov_degrees = 20,
                      .width = 5,
                      .height = 5};
  const BandArray albedo = layer(
      lit.render(camera, {.pass = Pass::interpolate, .layers = {Layer::albedo}}), Layer::albedo);
  for (int y = 0; y < 5; ++y) {
    EXPECT_EQ(albedo(5 * y, 0), 0.0f);
    EXPECT_NEAR(albedo(5 * y + 2, 0), 0.4f, 0.8f / 4 / 2);
    EXPECT_NEAR(albedo(5 * y + 4, 0), 0.8f, 1e-6f);
  }
}

TEST(Layers, IlluminanceIsSeenThroughGlassButNotInMirrors) {
  TracedScene lit(
      SceneBuilder()
          .square({.reflectance = 0.5f}, {0, 0, 0}, {0, 0, 1}, 50)
          .polygon({.index_of_refraction = 1.5f}, {{-9, -9, 1}, {0, -9, 1}, {0, 9, 1}, {-9, 9, 1}})
          .polygon({.specular = 0.9f}, {{0, -9, 1}, {9, -9, 1}, {9, 9, 1}, {0, 9, 1}})
          .build());
  // Irradiance is 1 on the floor and 5 at height 1, where only the mirror has elements.
  lit.set_direct([](const Eigen::Vector3d& p) { return p.z() > 0.5 ? 5.0f : 1.0f; });
  const Camera camera{.position = {0, 0, 3},
                      .direction = {0, 0, -1},
                      .up = {0, 1, 0},
                      .fov_degrees = 20,
                      .width = 4,
                      .height = 4};
  const Image image = lit.render(camera, {.pass = Pass::interpolate, .layers = all_layers()});
  const BandArray lux = layer(image, Layer::illuminance);
  EXPECT_NEAR(lux(0, 0), 683.0f, 0.01f);      // the floor's, through the glass
  EXPECT_NEAR(lux(3, 0), 5 * 683.0f, 0.05f);  // the mirror's own
  EXPECT_EQ(layer(image, Layer::direct)(0, 0), 0.0f);
  EXPECT_GT(layer(image, Layer::specular)(0, 0), 0.0f);
}

TEST(Layers, IlluminanceOfAMirrorHasTheSolutionsCaustics) {
  TracedScene lit(SceneBuilder().square({.specular = 0.9f}, {0, 0, 0}, {0, 0, 1}, 9).build());
  lit.set_indirect([](const auto&) { return 5.0f; });
  lit.solution.caustic_irradiance = lit.solution.indirect_irradiance;
  const Camera camera = camera_towards({0, 0, 3}, {0, 0, 0}, 20, 2);
  const Image image =
      lit.render(camera, {.pass = Pass::direct, .photons = 1 << 10, .layers = all_layers()});
  // Photons, which find no lamp here, pass mirrors, so they replace no caustics there. Some 16
  // operations in single precision (corners, bands, samples of a pixel) round by 6e-8 each.
  EXPECT_LT((layer(image, Layer::illuminance) / (683.0f * 5.0f) - 1.0f).abs().maxCoeff(), 1e-6f);
}

}  // namespace
}  // namespace lightwell::layers_test
