#include "raytrace/pixel_samples.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "scene/degree.h"
#include "tests/raytrace/lit_scene.h"

namespace lightwell::pixel_samples_test {
namespace {

constexpr auto pi_f = std::numbers::pi_v<float>;

// Variance of the window a0 - a1 cos + a2 cos 2 - a3 cos 3 over [-1.5, 1.5]:
// 1.5^2 (1/3 - (2 / pi^2 a0) (a1 - a2/4 + a3/9)) pixels^2.
double filter_variance() {
  const double pi = std::numbers::pi;
  return 2.25 * (1.0 / 3.0 - 2.0 / (pi * pi * 0.35875) * (0.48829 - 0.14128 / 4.0 + 0.01168 / 9.0));
}

TEST(FilterSampler, HaveTheMomentsOfTheWindow) {
  const FilterSampler places;
  constexpr int count = 100000;
  double mean = 0.0, square = 0.0;
  for (int i = 0; i < count; ++i) {
    const double x = places.offset((i + 0.5) / count);
    EXPECT_LE(std::abs(x), 1.5);
    mean += x / count;
    square += x * x / count;
  }
  EXPECT_NEAR(mean, 0.0, 1e-6);
  // The tolerance is the square of the steps of 3/256 pixels in which the window is constant.
  EXPECT_NEAR(square, filter_variance(), 3.0 / 256 * 3.0 / 256);
}

TEST(PixelSamples, EvenlyLitPixelsAreDoneAtOnceAndExact) {
  const TracedScene lit(
      SceneBuilder().box({.exitance = pi_f}, {-3, -3, -3}, {3, 3, 3}, true).build());
  const Camera camera = camera_towards({0, 0, 0}, {1, 1, 0}, 50, 8);
  RenderReport report;
  const Image image = lit.render(camera, {.sampling = {.most = 512, .least = 16}}, &report);
  EXPECT_EQ(report.eye_rays, 16 * 64);  // the least
  EXPECT_LT((image.radiance - 1.0f).abs().maxCoeff(), 1e-5f);
}

TEST(PixelSamples, StopWhereTheErrorIsAskedFor) {
  // Half of the picture's middle column is bright: samples there are 0 or 1.
  const TracedScene lit(SceneBuilder()
                            .polygon({.exitance = pi_f, .emits_both_sides = true},
                                     {{0, -9, -9}, {0, 9, -9}, {0, 9, 0}, {0, -9, 0}})
                            .build());
  const Camera camera{.position = {-5, 0, 0},
                      .direction = {1, 0, 0},
                      .up = {0, 0, 1},
                      .fov_degrees = 20,
                      .width = 5,
                      .height = 5};
  RenderReport coarse, fine;
  lit.render(camera, {.sampling = {.most = 4096, .noise = 0.1f}}, &coarse);
  lit.render(camera, {.sampling = {.most = 4096, .noise = 0.025f}}, &fine);
  EXPECT_GT(fine.eye_rays, 2 * coarse.eye_rays);
  EXPECT_LT(fine.eye_rays, 25 * 4096);
}

// In limited time tiles have fewer rows, which changes no pixel: tiles of 6 rows take over the
// first samples of the rows beside the tile before, and tiles of 24 rows their own.
TEST(PixelSamples, BitsDoNotDependOnTheRowsOfTiles) {
  const TracedScene lit(SceneBuilder()
                            .square({.specular = 0.9f, .roughness = 0.3f}, {0, 0, 0}, {0, 0, 1}, 3)
                            .square({.reflectance = 0.5f}, {2, 0, 1}, {-1, 0, 0}, 1)
                            .sphere({.exitance = pi_f}, {0, 1, 2}, 0.3)
                            .build());
  const Camera camera{.position = {-5, 0, 2},
                      .direction = {0.96, 0, -0.28},
                      .up = {0.28, 0, 0.96},
                      .fov_degrees = 40,
                      .width = 320,
                      .height = 50};
  for (const int most : {0, 32}) {  // gloss alone, and all pixels
    RenderOptions options{.sampling = {.most = most, .least = 4, .noise = 0.2f}};
    RenderReport usual, limited;
    const Image image = lit.render(camera, options, &usual);
    options.run.seconds_left = [] { return 1e6; };
    const Image in_time = lit.render(camera, options, &limited);
    EXPECT_EQ(usual.tiles, 3) << "of 24, 24 and 2 rows";
    EXPECT_EQ(limited.tiles, 9) << "of 6 rows, and 2";
    EXPECT_EQ(limited.eye_rays, usual.eye_rays);
    EXPECT_GT(usual.eye_rays, 2 * 320 * 50) << "gloss fills the lower half at least";
    EXPECT_TRUE((in_time.radiance == image.radiance).all()) << most;
  }
}

// A small lamp at distance d before a lens of radius r focused at f is a disk of radius
// r |1/d - 1/f| on the picture plane at distance 1, with variance radius^2 / 4 along each axis and
// the total light of a pinhole's picture.
TEST(DepthOfField, BlursAPointToADiskOfTheThinLens) {
  const double d = 2.0, lamp_radius = 0.01;
  const TracedScene lit(SceneBuilder().sphere({.exitance = pi_f}, {d, 0, 0}, lamp_radius).build());
  for (const double f : {1.2, 2.0, 4.0}) {
    Camera camera{.position = {0, 0, 0},
                  .direction = {1, 0, 0},
                  .up = {0, 0, 1},
                  .fov_degrees = 10,
                  .width = 48,
                  .height = 48,
                  .lens_radius = 0.06,
                  .focus_distance = f};
    const SampleOptions sampling{.most = 1024, .noise = 0.0f};
    const Image image = lit.render(camera, {.sampling = sampling});
    const double pixel = 2.0 * std::tan(5.0 * std::numbers::pi / 180.0) / 48;
    const Eigen::Vector2d middle = centroid(image);
    EXPECT_LT((middle - Eigen::Vector2d(24, 24)).norm(), 0.1);
    double power = 0.0, square = 0.0;
    for (Eigen::Index i = 0; i < image.radiance.rows(); ++i) {
      const double x = static_cast<double>(i % 48) + 0.5 - middle.x(), L = image.radiance(i, 0);
      power += L;
      square += L * x * x;
    }
    const double disk = 0.06 * std::abs(1.0 / d - 1.0 / f) / pixel, lamp = lamp_radius / d / pixel;
    EXPECT_NEAR(power, std::numbers::pi * lamp * lamp, 0.05 * power) << f;
    EXPECT_NEAR(square / power, (disk * disk + lamp * lamp) / 4.0 + filter_variance(),
                0.05 * square / power)
        << f;
  }
}

// 25 small lamps out of focus, each of which shows in one of 44 samples of the pixels of its disk:
// most pixels have none in their first 16 samples. The light of the picture is that of a pinhole,
// 25 squares. With h hits of independent samples its relative standard error is h^(-1/2); pixels
// take 256 samples where lamps are found, so h = 25 * 256 * 2.05. The tolerance is four standard
// errors, 3.5 %; pixels that ended with samples that all missed would lose 6 % and more.
TEST(DepthOfField, KeepsTheLightOfSmallLamps) {
  constexpr int width = 101, rows_of_lamps = 5;
  const double d = 4.0, edge = 0.02, apart = 0.25, pixel = 2.0 * std::tan(10.0 * degree) / width;
  SceneBuilder scene;
  for (int i = 0; i < rows_of_lamps * rows_of_lamps; ++i) {
    const double y = apart * (i % rows_of_lamps - 2), z = apart * (i / rows_of_lamps - 2);
    scene.polygon({.exitance = pi_f, .emits_both_sides = true},
                  {{d, y, z}, {d, y + edge, z}, {d, y + edge, z + edge}, {d, y, z + edge}});
  }
  const TracedScene lit(scene.build());
  const Camera camera{.position = {0, 0, 0},
                      .direction = {1, 0, 0},
                      .up = {0, 0, 1},
                      .fov_degrees = 20,
                      .width = width,
                      .height = width,
                      .lens_radius = 0.05,
                      .focus_distance = 2.0};
  const double light = lit.render(camera, {}).radiance.col(0).cast<double>().sum();
  const double square = edge / d / pixel, all = rows_of_lamps * rows_of_lamps * square * square;
  EXPECT_NEAR(light, all, 4.0 / std::sqrt(256.0 * all) * all);
}

}  // namespace
}  // namespace lightwell::pixel_samples_test
