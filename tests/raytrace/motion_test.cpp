// Motion blur against closed forms, and against the mean of many instants.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "raytrace/pixel_samples.h"
#include "scene/errors.h"
#include "scene/place_at_rest.h"
#include "tests/raytrace/lit_scene.h"

namespace lightwell::motion_test {
namespace {

using Eigen::Vector3d;

constexpr double pi = std::numbers::pi;
constexpr auto pi_f = std::numbers::pi_v<float>;

// A camera above the plane z = 0 whose picture is [-2, 2] wide there; the picture's x is the
// world's.
Camera overhead(int width, int height) {
  return {.name = "above",
          .position = {0, 0, 100},
          .direction = -Vector3d::UnitZ(),
          .up = Vector3d::UnitY(),
          .fov_degrees = 2.0 * std::atan(0.02) * 180.0 / pi,
          .width = width,
          .height = height,
          .shutter_open = 0.0,
          .shutter_close = 1.0};
}

// A square of radiance 1 and half width 0.5 on black that moves from x = -distance / 2 to
// distance / 2.
Scene moving_square(double distance, double degrees = 0.0) {
  Scene scene = SceneBuilder().square({.reflectance = 1.0f}, {0, 0, 0}, {0, 0, 1}, 0.5).build();
  scene.motions = {
      {.name = "m",
       .keys = {{.time = 0.0, .translation = {-0.5 * distance, 0, 0}},
                {.time = 1.0, .degrees = degrees, .translation = {0.5 * distance, 0, 0}}}}};
  scene.surfaces[0].motion = 0;
  place_at_rest(scene, 0.5);
  validate(scene);
  return scene;
}

const RenderOptions many_samples{.pass = Pass::interpolate,
                                 .sampling = {.most = 1024, .least = 1024, .noise = 0.0f}};

Image picture_of(const Scene& scene, const Camera& camera,
                 const RenderOptions& options = many_samples) {
  TracedScene lit(scene);
  lit.set_direct([](const Vector3d&) { return pi_f; });
  return lit.render(camera, options);
}

// Share of the time that the square covers x, seen through the pixel filter at x.
double expected_coverage(double x, double distance, double pixel) {
  static const FilterSampler filter;
  const auto covered = [&](double place) {
    const double from = std::max(place - 0.5, -0.5 * distance);
    const double to = std::min(place + 0.5, 0.5 * distance);
    return std::max(0.0, to - from) / distance;
  };
  constexpr int steps = 4096;
  double sum = 0.0;
  for (int i = 0; i < steps; ++i) sum += covered(x + pixel * filter.offset((i + 0.5) / steps));
  return sum / steps;
}

TEST(Motion, CoverageOfASquareIsTheTrapezoidOfItsWay) {
  for (const double distance : {0.4, 1.0, 1.8}) {
    const Image image = picture_of(moving_square(distance), overhead(64, 8));
    for (int x = 0; x < 64; ++x) {
      const double place = 4.0 * (x + 0.5) / 64.0 - 2.0;
      for (const int y : {2, 4, 6}) {
        EXPECT_NEAR(image.radiance(y * 64 + x, 0), expected_coverage(place, distance, 4.0 / 64),
                    6e-3)
            << distance << " " << place;
      }
    }
  }
}

TEST(Motion, EnergyOfThePictureIsKept) {
  Camera still = overhead(32, 32);
  still.shutter_open = still.shutter_close = 0.5;
  const double at_rest = picture_of(moving_square(1.5, 90.0), still).radiance.sum();
  const double moving = picture_of(moving_square(1.5, 90.0), overhead(32, 32)).radiance.sum();
  EXPECT_NEAR(moving / at_rest, 1.0, 2e-3);
  EXPECT_NEAR(at_rest / (3 * 8 * 8), 1.0, 2e-3) << "a sixteenth of the picture, in three bands";
}

// In a whole turn all directions have the same time: at radius r a bar of half width w covers a
// share 2 asin(w / r) / pi of the time.
TEST(Motion, BladeThatTurnsIsSeenForItsShareOfTheTurn) {
  const double w = 0.1, reach = 1.6;
  Scene scene = SceneBuilder()
                    .polygon({.reflectance = 1.0f},
                             {{-reach, -w, 0}, {reach, -w, 0}, {reach, w, 0}, {-reach, w, 0}})
                    .build();
  scene.motions = {{.keys = {{.time = 0.0}, {.time = 1.0, .degrees = 360.0}}}};
  scene.surfaces[0].motion = 0;
  place_at_rest(scene, 0.5);
  const Image image = picture_of(scene, overhead(32, 32));
  // 1024 random samples would have a standard error of sqrt(0.09 / 1024) = 9e-3; the errors of
  // Sobol samples are smaller everywhere.
  for (int y = 0; y < 32; ++y) {
    for (int x = 0; x < 32; ++x) {
      const double r = std::hypot(4.0 * (x + 0.5) / 32 - 2.0, 4.0 * (y + 0.5) / 32 - 2.0);
      if (r < 0.7 || r > 1.35) continue;
      EXPECT_NEAR(image.radiance(y * 32 + x, 0), 2.0 * std::asin(w / r) / pi, 8e-3) << r;
    }
  }
}

// A lamp over a floor with a mirror beside, and moving bodies between them.
Scene shadowed_floor() {
  Scene scene = SceneBuilder()
                    .square({.exitance = 200.0f}, {0.5, 0, 3}, {0, 0, -1}, 0.05)
                    .square({.reflectance = 0.6f}, {0, 0, 0}, {0, 0, 1}, 2.0)
                    .square({.specular = 0.9f}, {0, 1.6, 0.6}, {0, -1, 0.2}, 0.5)
                    .box({.reflectance = 0.4f}, {-0.3, -0.2, 0.8}, {0.3, 0.2, 1.0}, false)
                    .sphere({.reflectance = 0.7f}, {-0.9, -0.6, 0.3}, 0.25)
                    .build();
  scene.motions = {
      {.name = "block",
       .pivot = {0, 0, 0.9},
       .axis = Vector3d(1, 0, 1).normalized(),
       .keys = {{.time = 0.0}, {.time = 1.0, .degrees = 80.0, .translation = {0.5, 0.3, 0}}}},
      {.name = "ball", .keys = {{.time = 0.2}, {.time = 0.8, .translation = {0, 0.8, 0}}}}};
  scene.surfaces[3].motion = 0;
  scene.surfaces[4].motion = 1;
  return scene;
}

TEST(Motion, PictureIsTheMeanOfItsInstants) {
  Camera camera = camera_towards({0, -3, 5}, {0, 0, 0}, 40, 16);
  camera.shutter_close = 1.0;
  const RenderOptions options{.photons = 0,
                              .sampling = {.most = 1024, .least = 1024, .noise = 0.0f}};
  Scene scene = shadowed_floor();
  place_at_rest(scene, 0.5);
  const Image moving = TracedScene(scene).render(camera, options);
  constexpr int instants = 32;
  BandArray mean = BandArray::Zero(moving.radiance.rows(), moving.radiance.cols());
  for (int i = 0; i < instants; ++i) {
    Scene still = shadowed_floor();
    const double time = (i + 0.5) / instants;
    place_at_rest(still, time);
    camera.shutter_open = camera.shutter_close = time;
    mean +=
        TracedScene(still)
            .render(camera, {.photons = 0, .sampling = {.most = 32, .least = 32, .noise = 0.0f}})
            .radiance /
        static_cast<float>(instants);
  }
  const double error = std::sqrt((moving.radiance - mean).square().mean()) / mean.mean();
  RecordProperty("error", std::to_string(error));
  EXPECT_LT(error, 0.02);
  EXPECT_NEAR(moving.radiance.mean() / mean.mean(), 1.0, 3e-3);
}

TEST(Motion, GatheredPictureIsTheMeanOfItsInstantsToo) {
  const auto room = [] {
    Scene scene = SceneBuilder()
                      .box({.reflectance = 0.2f}, {-2, -2, 0}, {2, 2, 3}, true)
                      .box({.reflectance = 0.8f}, {-0.4, -0.4, 0.2}, {0.4, 0.4, 1.0}, false)
                      .build();
    scene.motions = {{.keys = {{.time = 0.0, .translation = {-0.8, 0, 0}},
                               {.time = 1.0, .degrees = 45.0, .translation = {0.8, 0, 0}}}}};
    scene.surfaces[1].motion = 0;
    return scene;
  };
  const auto render = [&](double open, double close, int samples) {
    Scene scene = room();
    place_at_rest(scene, 0.5 * (open + close));
    TracedScene lit(scene);
    // Only the block is bright; its light on the walls moves with the block.
    lit.set_indirect([](const Vector3d& p) {
      return p.head<2>().cwiseAbs().maxCoeff() < 1.9 && p.z() > 0.1 && p.z() < 2.9 ? pi_f : 0.0f;
    });
    Camera camera = camera_towards({0, -1.9, 2.5}, {0, 0, 0.2}, 60, 8);
    camera.shutter_open = open;
    camera.shutter_close = close;
    return lit
        .render(camera, {.pass = Pass::gather,
                         .gather_rays = 256,
                         .photons = 0,
                         .sampling = {.most = samples, .least = samples, .noise = 0.0f}})
        .radiance;
  };
  const BandArray moving = render(0.0, 1.0, 512);
  BandArray mean = BandArray::Zero(moving.rows(), moving.cols());
  constexpr int instants = 32;
  for (int i = 0; i < instants; ++i) {
    const double time = (i + 0.5) / instants;
    mean += render(time, time, 64) / static_cast<float>(instants);
  }
  EXPECT_NEAR(moving.mean() / mean.mean(), 1.0, 5e-3);
  // All instants draw the same 1024 directions in a pixel, with noise of 5 %.
  EXPECT_LT(std::sqrt((moving - mean).square().mean()) / mean.mean(), 0.1);
}

TEST(Motion, CameraThatMovesSeesWhatStandsStillMoveBackwards) {
  Scene scene = moving_square(1.0);
  Camera camera = overhead(32, 8);
  const Image expected = picture_of(scene, camera);
  scene.motions[0].keys[0].translation *= -1.0;
  scene.motions[0].keys[1].translation *= -1.0;
  scene.surfaces[0].motion = -1;
  camera.motion = 0;
  const Image found = picture_of(scene, camera);
  // The same samples follow the motion in reverse; a sample at an edge may round to the other side.
  EXPECT_LT((found.radiance - expected.radiance).abs().maxCoeff(), 1e-3f);
}

TEST(Motion, WithTheShutterClosedNothingMovesAndNoBitChanges) {
  Camera camera = camera_towards({0, -3, 5}, {0, 0, 0}, 40, 32);
  camera.shutter_open = camera.shutter_close = 0.5;
  Scene scene = shadowed_floor();
  place_at_rest(scene, 0.5);
  const Image instant = TracedScene(scene).render(camera);
  for (Surface& surface : scene.surfaces) surface.motion = -1;
  camera.shutter_close = 0.7;  // open, but nothing moves
  EXPECT_TRUE((TracedScene(scene).render(camera).radiance == instant.radiance).all());
}

TEST(Motion, ShuttersThatCannotBeAreRefused) {
  const Scene scene = moving_square(1.0);
  const auto refused = [&](double open, double close, const std::string& words) {
    Camera camera = overhead(32, 8);
    camera.shutter_open = open;
    camera.shutter_close = close;
    try {
      picture_of(scene, camera);
    } catch (const InputError& error) {
      EXPECT_NE(std::string(error.what()).find(words), std::string::npos) << error.what();
      return;
    }
    ADD_FAILURE() << open << " " << close;
  };
  refused(1.0, 0.0, "close before it opens");
  refused(0.0, std::numeric_limits<double>::quiet_NaN(), "finite");
  refused(0.0, std::numeric_limits<double>::infinity(), "finite");
  refused(0.0, 2.0, "light is solved for 0.5 s");
}

TEST(Motion, LampsStandStill) {
  Scene scene = moving_square(1.0);
  scene.materials[0].emission.setOnes();
  EXPECT_THROW(validate(scene), InputError);
  scene.materials[0].emission.setZero();
  scene.motions[0].keys.pop_back();
  EXPECT_THROW(validate(scene), InputError) << "one key";
}

}  // namespace
}  // namespace lightwell::motion_test
