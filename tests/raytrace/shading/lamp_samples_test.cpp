// Directions towards lamps and their probability density.
#include "raytrace/shading/lamp_samples.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "mesh/build_patches.h"
#include "radiosity/closed_forms/polygon_form_factor.h"
#include "scene/sampling.h"
#include "tests/radiosity/test_scenes.h"

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

// The mean of f / density over drawn directions is the integral of f over the lamps' solid angles:
// f = cos / pi gives the sum of the form factors.
double summed_form_factors(const LampSamples& lamps, const Eigen::Vector3d& from) {
  constexpr int count = 1 << 14;
  const SobolPoints sobol(count);
  double sum = 0.0;
  for (int i = 0; i < count; ++i) {
    const Eigen::Array4d u = sobol.point(i, 3).cast<double>();
    const auto sample = lamps.draw(from, -1, u[0], u[1], u[2]);
    if (!sample) continue;
    const Eigen::Vector3d place = from + sample->distance * sample->direction;
    EXPECT_NEAR(lamps.density(from, place, sample->emitter->facet) / sample->density, 1.0, 1e-9);
    sum += sample->direction.z() * std::numbers::inv_pi / sample->density;
  }
  return sum / count;
}

TEST(LampSamples, AreDrawnByTheStatedDensity) {
  // Up to most_weighed lamps have weights by position and power, more lamps by power alone.
  for (const int count : {1, 5, LampSamples::most_weighed + 10}) {
    const Room room{.lamps = count};
    const LampSamples lamps(room.direct_light);
    const Eigen::Vector3d from{1.1, 2.6, 1.0};
    double F = 0.0;
    for (int i = 0; i < count; ++i) F += point_to_polygon(from, {0, 0, 1}, Room::lamp(i));
    const double estimate = summed_form_factors(lamps, from);
    std::printf("%d lamps: sum of form factors %.6f, by draws %.6f\n", count, F, estimate);
    // If lamps are drawn by power, one in five draws among 74 lamps is the uplight, which gives no
    // light here, and the others differ by up to twice their mean: the standard deviation is at
    // most 2, and less for stratified points. The tolerance is four standard errors.
    EXPECT_NEAR(estimate / F, 1.0, 4.0 * 2.0 / std::sqrt(double{1 << 14}));
  }
}

TEST(LampSamples, AreOfLampsThatFaceThePlace) {
  const Room room{.lamps = 1};
  const LampSamples lamps(room.direct_light);
  const SobolPoints sobol(256);
  for (int i = 0; i < sobol.count(); ++i) {
    const Eigen::Array4d u = sobol.point(i, 5).cast<double>();
    // The uplight has sixteen times the power, all of it upwards.
    const auto below = lamps.draw({2, 2, 1}, -1, u[0], u[1], u[2]);
    ASSERT_TRUE(below);
    EXPECT_LT(below->emitter->normal.z(), 0.0);
  }
}

}  // namespace
}  // namespace lightwell::lamp_samples_test
