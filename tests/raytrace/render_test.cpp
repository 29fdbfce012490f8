#include "raytrace/render.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "radiosity/emitters/emitter.h"
#include "radiosity/journal/journal.h"
#include "scene/errors.h"
#include "scene/parallel.h"
#include "tests/raytrace/lit_scene.h"
#include "tests/temporary_folder.h"

namespace lightwell::render_test {
namespace {

constexpr auto pi_f = std::numbers::pi_v<float>;

/// Every wall emits M and reflects rho: B = M / (1 - rho) and E = B everywhere.
class Furnace : public ::testing::TestWithParam<std::tuple<Pass, int>> {};

TEST_P(Furnace, EveryPixelShowsBOverPi) {
  const auto [pass, bands] = GetParam();
  constexpr float M = 1.0f, rho = 0.6f, B = M / (1.0f - rho);
  TracedScene lit(
      SceneBuilder(bands == 3 ? rgb_bands() : spectral_bands(400, 700, bands))
          .box({.reflectance = rho, .exitance = M, .one_sided = true}, {0, 0, 0}, {2, 1, 1.5}, true)
          .box({.reflectance = rho, .exitance = M, .one_sided = true}, {0.5, 0, 0.5},
               {0.8, 0.4, 0.7}, false)
          .sphere({.reflectance = rho, .exitance = M, .one_sided = true}, {1.2, 0.5, 0.9}, 0.3)
          .build());
  ASSERT_TRUE(lit.direct_light.emitters().empty());  // every wall emits: gathers find the emission
  lit.set_indirect([](const auto&) { return B; });
  Camera camera = camera_towards({0.1, 0.9, 0.1}, {1.5, 0.2, 1.2}, 70, 48);
  camera.height = 31;
  const Image image = lit.render(camera, {.pass = pass});
  ASSERT_EQ(image.radiance.rows(), 48 * 31);
  ASSERT_EQ(image.radiance.cols(), bands);
  EXPECT_LT((image.radiance - B / pi_f).abs().maxCoeff(), 1e-5f * B / pi_f);
}

INSTANTIATE_TEST_SUITE_P(PassesAndBands, Furnace,
                         ::testing::Combine(::testing::Values(Pass::interpolate, Pass::direct,
                                                              Pass::gather),
                                            ::testing::Values(3, 7)));

TEST(Render, InterpolatedLinearIrradianceIsExactInEveryPixel) {
  // E = 1 + x + 2 y on the floor: vertices interpolate it exactly, and the mean over a pixel's
  // square of a function that is nearly linear across it is its value at the centre.
  TracedScene lit(SceneBuilder()
                      .polygon({.reflectance = 1.0f}, {{0, 0, 0}, {2, 0, 0}, {2, 1, 0}, {0, 1, 0}})
                      .build());
  const auto E = [](const Eigen::Vector3d& p) { return static_cast<float>(1 + p.x() + 2 * p.y()); };
  lit.set_direct(E);
  const Camera camera{.position = {1, 0.5, 4},
                      .direction = {0, 0, -1},
                      .up = {0, 1, 0},
                      .fov_degrees = 10,
                      .width = 20,
                      .height = 20};
  const Image image = lit.render(camera, {.pass = Pass::interpolate});
  const double pixel = 2 * 4 * std::tan(5 * std::numbers::pi / 180) / 20;
  for (int y = 0; y < 20; ++y) {
    for (int x = 0; x < 20; ++x) {
      const Eigen::Vector3d p(1 + (x - 9.5) * pixel, 0.5 - (y - 9.5) * pixel, 0);
      // Float distances of the caster have an error of 1e-6.
      EXPECT_NEAR(image.radiance(20 * y + x, 0), E(p) / pi_f, 1e-5);
    }
  }
}

TEST(Render, PixelsAreMeansOverTheirSquares) {
  // A slanted half-plane of radiance 1: the sum over the picture is the area it covers.
  const TracedScene lit(
      SceneBuilder()
          .polygon({.exitance = pi_f}, {{-9, -8.9, 0}, {9, -8.9, 0}, {9, 3.3, 0}, {-9, -2.7, 0}})
          .build());
  const Camera camera{.position = {0, 0, 10},
                      .direction = {0, 0, -1},
                      .up = {0, 1, 0},
                      .fov_degrees = 2 * std::atan(0.1) * 180 / std::numbers::pi,  // 2 m wide
                      .width = 24,
                      .height = 24};
  constexpr int levels = 4;
  const Image image = lit.render(camera, {.max_subdivision = levels});
  const double pixel = 2.0 / 24;
  double worst = 0.0, sum = 0.0;
  for (int y = 0; y < 24; ++y) {
    for (int x = 0; x < 24; ++x) {
      // The exact coverage is the integral of the edge y = 0.3 + x / 3 over the pixel.
      const double left = -1 + x * pixel, bottom = 1 - (y + 1) * pixel;
      double cover = 0.0;
      constexpr int slices = 2000;
      for (int s = 0; s < slices; ++s) {
        const double edge = 0.3 + (left + (s + 0.5) * pixel / slices) / 3;
        cover += std::clamp((edge - bottom) / pixel, 0.0, 1.0) / slices;
      }
      worst = std::max(worst, std::abs(image.radiance(24 * y + x, 0) - cover));
      sum += image.radiance(24 * y + x, 0) - cover;
    }
  }
  // The edge crosses at most 2^levels + 2^levels / 3 + 1 of 4^levels cells, each with an error of
  // at most one half.
  EXPECT_LT(worst, 0.5 * (4.0 / 3.0 * 16 + 1) / 256);
  EXPECT_LT(std::abs(sum) / (24 * 24), 1e-3);
}

// A camera 8 m above the plane z = 0 that shows 1.6 m in 16 pixels.
Camera camera_above() {
  return {.position = {0, 0, 8},
          .direction = {0, 0, -1},
          .up = {0, 1, 0},
          .fov_degrees = 2 * std::atan(0.1) * 180 / std::numbers::pi,
          .width = 16,
          .height = 16};
}

TEST(Render, StripThinnerThanAPixelIsNotLost) {
  // A strip of 0.4 pixels runs through the middle of a column of pixels, between all their corners.
  const double pixel = 0.1;
  const double half = 0.2 * pixel, middle = 0.5 * pixel;
  const TracedScene lit(SceneBuilder()
                            .polygon({.exitance = pi_f}, {{middle - half, -5, 0},
                                                          {middle + half, -5, 0},
                                                          {middle + half, 5, 0},
                                                          {middle - half, 5, 0}})
                            .build());
  const Image image = lit.render(camera_above(), {.max_subdivision = 4});
  EXPECT_NEAR(image.radiance.col(0).mean(), 0.4 / 16, 0.1 / 16);  // 16 cells: error below 1/16
  for (int y = 0; y < 16; ++y) EXPECT_GT(image.radiance(16 * y + 8, 0), 0.3f);
}

// A bright strip before the edge between two dark surfaces, so narrow that no sample sees the
// strip.
TEST(Render, StripAlongAnEdgeIsNotLost) {
  constexpr double pixel = 0.1, cell = pixel / 4, width = cell / 2;
  constexpr double left = 1.25 * cell, right = left + width, edge = 1.5 * cell;
  const auto plate = [](double from, double to, double z) -> std::vector<Eigen::Vector3d> {
    return {{from, -5, z}, {to, -5, z}, {to, 5, z}, {from, 5, z}};
  };
  const TracedScene lit(SceneBuilder()
                            .polygon({}, plate(-5, edge, 0))
                            .polygon({}, plate(edge - 0.01, 5, -0.01))
                            .polygon({.exitance = pi_f}, plate(left, right, 0.01))
                            .build());
  const Image image = lit.render(camera_above(), {.max_subdivision = 2});
  // The strip covers an eighth of the pixel. Of the 16 rays through each of the four cells, one
  // lies in each of 16 columns, so the strip's share of a cell is right within a 16th.
  for (int y = 0; y < 16; ++y) {
    EXPECT_NEAR(image.radiance(16 * y + 8, 0), width / pixel, cell / pixel / 16) << y;
  }
}

TEST(Render, WorldOutsideIsBlack) {
  TracedScene lit(SceneBuilder().square({.reflectance = 1.0f}, {0, 0, 0}, {0, 0, 1}, 0.5).build());
  lit.set_direct([](const auto&) { return 1.0f; });
  const Camera camera = camera_towards({0, 0, 3}, {0, 0, 0}, 40, 16);
  const Image image = lit.render(camera, {.pass = Pass::interpolate});
  EXPECT_EQ(image.radiance.row(0).maxCoeff(), 0.0f);
  EXPECT_GT(image.radiance.row(16 * 8 + 8).minCoeff(), 0.0f);
}

TEST(Render, EveryPathBetweenTwoMirrorsIsCutOnce) {
  const TracedScene lit(SceneBuilder()
                            .square({.specular = 1.0f}, {0, 0, 0}, {0, 0, 1}, 1000)
                            .square({.specular = 1.0f}, {0, 0, 1}, {0, 0, -1}, 1000)
                            .build());
  const Camera camera = camera_towards({0, 0, 0.5}, {1, 0, 0}, 30, 8);
  Camera tilted = camera_towards({0, 0, 0.5}, {1, 0.2, 1}, 30, 8);
  RenderReport report;
  lit.render(tilted, {}, &report);
  EXPECT_GE(report.eye_rays, 81);
  EXPECT_EQ(report.depth_cut, report.eye_rays);
  EXPECT_DOUBLE_EQ(report.cut_share, 1.0);
  // A branch at a lossy mirror ends when its contribution is negligible, and is not counted as cut.
  const TracedScene dim(SceneBuilder()
                            .square({.specular = 0.1f}, {0, 0, 0}, {0, 0, 1}, 1000)
                            .square({.specular = 0.1f}, {0, 0, 1}, {0, 0, -1}, 1000)
                            .build());
  dim.render(tilted, {.min_contribution = 1e-3f}, &report);
  EXPECT_EQ(report.depth_cut, 0);
  EXPECT_EQ(report.cut_share, 0.0);
}

/// A room with a small lamp, a block, a mirror and a glass sphere.
TracedScene& furnished_room() {
  static TracedScene lit(
      SceneBuilder()
          .box({.reflectance = 0.5f, .one_sided = true}, {0, 0, 0}, {2, 2, 2}, true)
          .square({.exitance = 10.0f, .one_sided = true}, {1, 1.99, 1}, {0, -1, 0}, 0.3)
          .box({.reflectance = 0.3f, .specular = 0.4f, .one_sided = true}, {0.3, 0, 1.2},
               {0.8, 1, 1.6}, false)
          .sphere({.index_of_refraction = 1.5f}, {1.4, 0.4, 0.9}, 0.4)
          .build());
  lit.set_indirect([](const Eigen::Vector3d& p) { return static_cast<float>(0.2 + 0.1 * p.y()); });
  return lit;
}

TEST(Render, OneThreadAndTwoGiveTheSameBits) {
  const TracedScene& lit = furnished_room();
  ASSERT_EQ(lit.direct_light.emitters().size(), 1u);
  const Camera camera = camera_towards({1, 1, 0.05}, {1, 0.8, 2}, 80, 40);
  Image one, two;
  {
    const ThreadLimit limit(1);
    one = lit.render(camera);
  }
  {
    const ThreadLimit limit(2);
    two = lit.render(camera);
  }
  EXPECT_TRUE((one.radiance == two.radiance).all());
  EXPECT_GT(one.radiance.mean(), 0.0f);
}

TEST(Render, FinerSubdivisionConvergesToTheSamePicture) {
  const TracedScene& lit = furnished_room();
  const Camera camera = camera_towards({1, 1, 0.05}, {1, 0.8, 2}, 80, 24);
  const Image reference = lit.render(camera, {.max_subdivision = 4, .contrast = 0.01f});
  double previous = 1e9;
  for (const int levels : {0, 1, 2, 3}) {
    const Image image = lit.render(camera, {.max_subdivision = levels});
    const double error = std::sqrt((image.radiance - reference.radiance).square().mean());
    EXPECT_LT(error, previous);
    previous = error;
  }
}

TEST(Render, ProgressRisesToOneAndStopsTheWork) {
  const TracedScene& lit = furnished_room();
  Camera camera = camera_towards({1, 1, 0.05}, {1, 0.8, 2}, 80, 8);
  camera.height = 3000;  // several strips
  std::vector<double> shares;
  const Progress record = [&](std::string_view phase, double share) {
    EXPECT_EQ(phase, "render");
    shares.push_back(share);
    return true;
  };
  lit.render(camera,
             {.pass = Pass::interpolate, .max_subdivision = 0, .run = {.progress = record}});
  EXPECT_TRUE(std::is_sorted(shares.begin(), shares.end()));
  EXPECT_EQ(shares.front(), 0.0);
  EXPECT_EQ(shares.back(), 1.0);

  int calls = 0;
  const Progress stop = [&](std::string_view, double) { return ++calls < 2; };
  EXPECT_THROW(lit.render(camera, {.run = {.progress = stop}}), Interrupted);
  EXPECT_EQ(calls, 2);
}

/// A tall picture, so that it has several tiles.
Camera tall_camera() {
  Camera camera = camera_towards({1, 1, 0.05}, {1, 0.8, 2}, 80, 8);
  camera.height = 3000;
  return camera;
}

TEST(Render, StoppedAnywhereAndGoneOnWithItHasTheSameBits) {
  const TracedScene& lit = furnished_room();
  const Camera camera = tall_camera();
  RenderOptions options{.pass = Pass::interpolate,
                        .max_subdivision = 1,
                        .layers = {Layer::normal, Layer::depth, Layer::luminance}};
  RenderReport of_whole;
  const Image whole = lit.render(camera, options, &of_whole);
  const TemporaryFolder folder;
  const Provenance of{.version = "1", .scene_hash = 7};
  // 3000 rows of 8 pixels are 3 tiles of 8192 pixels. Each run resumes with one more finished tile,
  // on another number of threads.
  for (int done = 1; done <= 3; ++done) {
    Journal journal(folder / "J", of);
    options.run.journal = &journal;
    int calls = 0;
    options.run.progress = [&](std::string_view, double) { return ++calls <= done; };
    const ThreadLimit limit(done);
    EXPECT_THROW(lit.render(camera, options), Interrupted);
    journal.close();
  }
  Journal journal(folder / "J", of);
  options.run.journal = &journal;
  options.run.progress = {};
  RenderReport report;
  const Image image = lit.render(camera, options, &report);
  EXPECT_TRUE((image.radiance == whole.radiance).all());
  EXPECT_TRUE((image.layers.values == whole.layers.values).all());
  EXPECT_EQ(report.tiles, 3);
  EXPECT_EQ(report.recalled_tiles, 3);
  EXPECT_EQ(report.eye_rays, of_whole.eye_rays);
}

TEST(Render, TilesOfAnotherPictureAreNotTaken) {
  TracedScene& lit = furnished_room();
  const Camera camera = camera_towards({1, 1, 0.05}, {1, 0.8, 2}, 80, 8);
  const TemporaryFolder folder;
  const auto recalled = [&](const Camera& from, const RenderOptions& asked) {
    Journal journal(folder / "J", {.version = "1"});
    RenderOptions options = asked;
    options.run.journal = &journal;
    RenderReport report;
    lit.render(from, options, &report);
    journal.close();
    return report.recalled_tiles;
  };
  const RenderOptions plain{.pass = Pass::interpolate};
  EXPECT_EQ(recalled(camera, plain), 0);
  EXPECT_EQ(recalled(camera, plain), 1);
  Camera moved = camera;
  moved.position.x() += 1e-9;
  EXPECT_EQ(recalled(moved, plain), 0);
  EXPECT_EQ(recalled(camera, {.pass = Pass::direct}), 0);
  EXPECT_EQ(recalled(camera, {.pass = Pass::interpolate, .contrast = 0.2f}), 0);
  EXPECT_EQ(recalled(camera, {.pass = Pass::interpolate, .layers = {Layer::depth}}), 0);
  const BandArray indirect = lit.solution.indirect_irradiance;
  lit.solution.indirect_irradiance(3, 0) += 0.5f;
  EXPECT_EQ(recalled(camera, plain), 0);
  lit.solution.indirect_irradiance = indirect;
  EXPECT_EQ(recalled(camera, plain), 1);
}

TEST(Render, ImpossibleOptionsAreRefused) {
  const TracedScene& lit = furnished_room();
  const Camera camera = camera_towards({1, 1, 0.05}, {1, 0.8, 2}, 80, 8);
  EXPECT_THROW(lit.render(camera, {.max_depth = -1}), std::invalid_argument);
  EXPECT_THROW(lit.render(camera, {.max_subdivision = 7}), std::invalid_argument);
  EXPECT_THROW(lit.render(camera, {.contrast = std::nanf("")}), std::invalid_argument);
  EXPECT_THROW(lit.render(camera, {.min_contribution = -1.0f}), std::invalid_argument);
  Camera flat = camera;
  flat.height = 0;
  EXPECT_THROW(lit.render(flat), InputError);
}

}  // namespace
}  // namespace lightwell::render_test
