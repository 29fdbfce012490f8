// Directions towards lamps and their probability density.
#include "raytrace/shading/lamp_samples.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <vector>

#include "mesh/build_patches.h"
#include "scene/sampling.h"
#include "tests/radiosity/test_scenes.h"
#include "tests/sample_mean.h"

namespace lightwell::lamp_samples_test {
namespace {

// A room of 4 m with emitting squares that face down, and an uplight in its middle.
struct Room {
  int lamps;  // squares that face down
  Scene scene = [this] {
    Scene made;
    const int grey = test::add_material(made, test::diffuse(made.bands, 0.5f));
    const int light = test::add_material(made, test::diffuse(made.bands, 0.0f, 10.0f));
    test::add_box(made, {0, 0, 0}, {4, 4, 4}, {grey, grey, grey, grey, grey, grey}, true);
    for (int i = 0; i < lamps; ++i) test::add_polygon(made, "lamp", light, lamp(i));
    test::add_polygon(made, "uplight", light,
                      {{1.9, 1.9, 2}, {2.1, 1.9, 2}, {2.1, 2.1, 2}, {1.9, 2.1, 2}});
    return made;
  }();
  PatchMesh mesh = build_patches(scene, {.max_patch_size = 2.0});
  DirectLight direct_light{scene, mesh};

  // Vertices of lamp i, counter-clockwise as seen from below.
  static Loop lamp(int i) {
    const double x = 0.1 + 0.4 * (i % 9), y = 0.1 + 0.4 * static_cast<int>(i / 9.0), a = 0.05;
    return {{x, y, 3.5}, {x, y + a, 3.5}, {x + a, y + a, 3.5}, {x + a, y, 3.5}};
  }
};

// A rough mirror below the lamps, seen from a corner of the room.
struct Mirror {
  Material material;
  Eigen::Vector3d position{1.1, 2.6, 1.0};
  SurfaceInteraction interaction;
  RoughLobe lobe;
  LobeView view{position, interaction, lobe};

  Mirror(const Scene& scene, double roughness)
      : material(test::mirror(scene.bands, 0.9f)),
        interaction{.material = material,
                    .direction = Eigen::Vector3d(0.4, -0.3, -0.9).normalized(),
                    .normal = Eigen::Vector3d::UnitZ()},
        lobe([&] {
          material.specular_roughness = static_cast<float>(roughness);
          return RoughLobe(material, false);
        }()) {}
};

// The integral of the lobe's density over a square lamp of `count` x `count` parts.
double lobe_over(const Mirror& mirror, const Loop& square, int count) {
  const Eigen::Vector3d a = square[1] - square[0], b = square[3] - square[0];
  const double area = a.cross(b).norm() / (count * count);
  double sum = 0.0;
  for (int i = 0; i < count; ++i) {
    for (int j = 0; j < count; ++j) {
      const Eigen::Vector3d to =
          square[0] + (i + 0.5) / count * a + (j + 0.5) / count * b - mirror.position;
      const Eigen::Vector3d direction = to.normalized();
      sum += mirror.lobe.density(mirror.interaction, direction) * direction.z() * area /
             to.squaredNorm();
    }
  }
  return sum;
}

constexpr int draw_count = 1 << 14;

// The mean of f / density over drawn directions is the integral of f over the lamps' solid angles:
// the lobe's density gives the share of the lobe that meets lamps.
test::SampleMean share_by_draws(const LampSamples& lamps, const Mirror& mirror) {
  const SobolPoints sobol(draw_count);
  std::vector<double> draws;
  for (int i = 0; i < draw_count; ++i) {
    const Eigen::Array4d u = sobol.point(i, 3).cast<double>();
    const auto sample = lamps.draw(mirror.view, -1, u[0], u[1], u[2]);
    draws.push_back(0.0);
    if (!sample) continue;
    const Eigen::Vector3d place = mirror.position + sample->distance * sample->direction;
    // Forty roundings of the chance along the tree, and of the density.
    EXPECT_NEAR(lamps.density(mirror.view, place, sample->emitter->facet) / sample->density, 1.0,
                1e-9);
    draws.back() = mirror.lobe.density(mirror.interaction, sample->direction) / sample->density;
  }
  return test::mean_of(draws);
}

TEST(LampSamples, AreDrawnByTheStatedDensity) {
  for (const int count : {1, 5, 80}) {
    for (const double roughness : {0.1, 0.4, 0.8}) {
      const Room room{.lamps = count};
      const LampSamples lamps(room.direct_light);
      const Mirror mirror(room.scene, roughness);
      double share = 0.0;
      for (int i = 0; i < count; ++i) share += lobe_over(mirror, Room::lamp(i), 64);
      const test::SampleMean by_draws = share_by_draws(lamps, mirror);
      std::printf("%d lamps, roughness %.1f: share of the lobe %.6g, by draws %.6g +- %.1g\n",
                  count, roughness, share, by_draws.value, by_draws.standard_error);
      // Four standard errors. The lobe changes by less than a thousandth of its greatest value
      // between parts of a lamp, which are 0.02 degrees apart.
      EXPECT_NEAR(by_draws.value, share, 4.0 * by_draws.standard_error + 1e-3 * share);
    }
  }
}

TEST(LampSamples, AreOfLampsThatFaceThePlace) {
  const Room room{.lamps = 1};
  const LampSamples lamps(room.direct_light);
  const Mirror mirror(room.scene, 0.4);
  const SobolPoints sobol(256);
  for (int i = 0; i < sobol.count(); ++i) {
    const Eigen::Array4d u = sobol.point(i, 5).cast<double>();
    // The uplight has sixteen times the power, all of it upwards.
    const auto below = lamps.draw(mirror.view, -1, u[0], u[1], u[2]);
    ASSERT_TRUE(below);
    EXPECT_LT(below->emitter->normal.z(), 0.0);
  }
}

TEST(LampSamples, OfManyLampsFallIntoTheLobe) {
  const Room room{.lamps = 80};
  const LampSamples lamps(room.direct_light);
  const Mirror mirror(room.scene, 0.1);
  const SobolPoints sobol(draw_count);
  double in_lobe = 0.0;
  for (int i = 0; i < draw_count; ++i) {
    const Eigen::Array4d u = sobol.point(i, 7).cast<double>();
    const auto sample = lamps.draw(mirror.view, -1, u[0], u[1], u[2]);
    if (!sample) continue;
    const double turned = sample->direction.dot(Eigen::Vector3d(0.4, -0.3, 0.9).normalized());
    if (turned > std::cos(20.0 / 180.0 * std::numbers::pi)) in_lobe += 1.0 / draw_count;
  }
  std::printf("draws within 20 degrees of the mirrored direction: %.3f\n", in_lobe);
  // 27 of the 80 lamps lie within 20 degrees. Draws by power meet these 28 of 100 times, since the
  // uplight has the power of sixteen lamps.
  EXPECT_GT(in_lobe, 0.5);
}

TEST(LampSamples, OfSourcesHaveTheSumAsTheirMean) {
  Scene scene;
  const int grey = test::add_material(scene, test::diffuse(scene.bands, 0.5f));
  test::add_box(scene, {0, 0, 0}, {4, 4, 4}, {grey, grey, grey, grey, grey, grey}, true);
  for (int k = 0; k < 100; ++k) {
    Lamp lamp{.name = "lamp",
              .position = {0.1 + 0.38 * (k % 10), 0.1 + 0.038 * k, 3.5},
              .axes = lamp_axes(Eigen::Vector3d(0.01 * k - 0.5, 0.2, -1.0).normalized()),
              .intensity = constant_spectrum(scene.bands, 1.0f + 0.1f * static_cast<float>(k))};
    if (k % 2 == 0) lamp.shape = SpotCone{.inner = 0.3, .outer = 0.9};
    scene.lamps.push_back(lamp);
  }
  scene.sky = dark_sky(scene.bands);
  scene.sky->sun = Sun{.direction = Eigen::Vector3d(0.5, -0.2, 0.8).normalized(),
                       .irradiance = constant_spectrum(scene.bands, 3.0f)};
  const PatchMesh mesh = build_patches(scene, {.max_patch_size = 2.0});
  const DirectLight light(scene, mesh);
  const LampSamples lamps(light);
  const Mirror mirror(scene, 0.5);
  const auto off_mirror = [&](const FreeSource& source) {
    const SourceSample sample = sample_source(source, mirror.position, 0.5, 0.5);
    return sample.irradiance * static_cast<double>(source.light.mean()) *
           mirror.lobe.density(mirror.interaction, sample.direction);
  };
  double sum = 0.0;
  for (const FreeSource& source : light.free_sources()) sum += off_mirror(source);
  std::vector<double> draws;
  for (int i = 0; i < draw_count; ++i) {
    const auto drawn = lamps.draw_source(mirror.view, (i + 0.5) / draw_count);
    draws.push_back(drawn ? off_mirror(*drawn->source) / drawn->chance : 0.0);
  }
  const test::SampleMean mean = test::mean_of(draws);
  std::printf("light of 101 sources off a rough mirror %.6g, by draws %.6g +- %.1g\n", sum,
              mean.value, mean.standard_error);
  // Evenly spaced numbers miss the mean of a step function of at most 101 steps by less than one
  // draw for each step; four standard errors of independent draws are the greater allowance.
  EXPECT_NEAR(mean.value, sum, 4.0 * mean.standard_error);
}

}  // namespace
}  // namespace lightwell::lamp_samples_test
