#include "raytrace/readings/sure_gather.h"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <numbers>

#include "radiosity/closed_forms/polygon_form_factor.h"
#include "raytrace/readings/probe.h"
#include "scene/parallel.h"
#include "tests/raytrace/lit_scene.h"

namespace lightwell::sure_gather_test {
namespace {

using Eigen::Vector3d;

constexpr double pi = std::numbers::pi;
const Vector3d up = Vector3d::UnitZ();

/// A black room of 4 x 4 x 3 m without a roof, under a uniform sky of radiance 1. Light at a point
/// is pi times the form factor of the opening.
std::unique_ptr<TracedScene> roofless_room() {
  const Paint black{.one_sided = true};
  const Loop floor = {{0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {0, 4, 0}};
  SceneBuilder builder;
  builder.polygon(black, {floor.begin(), floor.end()});
  for (std::size_t i = 0; i < 4; ++i) {
    const Vector3d a = floor[i], b = floor[(i + 1) % 4];
    builder.polygon(black, {a, a + 3.0 * up, b + 3.0 * up, b});
  }
  Scene scene = builder.build();
  scene.sky = Sky{.up = up,
                  .north = Vector3d::UnitY(),
                  .bright = up,
                  .scale = constant_spectrum(scene.bands, 1.0f),
                  .ground = constant_spectrum(scene.bands, 0.0f)};
  return std::make_unique<TracedScene>(std::move(scene));
}

double opening_lux(const TracedScene& room, const Probe& probe) {
  const Loop opening = {{0, 0, 3}, {4, 0, 3}, {4, 4, 3}, {0, 4, 3}};
  const double E = pi * std::abs(point_to_polygon(probe.position, probe.normal, {opening}));
  return luminous(room.scene.bands, constant_spectrum(room.scene.bands, static_cast<float>(E)));
}

std::vector<Probe> floor_probes(int each_way) {
  std::vector<Probe> probes;
  for (int i = 0; i < each_way * each_way; ++i) {
    const double x = (i % each_way + 0.37) / each_way, y = (i / each_way + 0.61) / each_way;
    probes.push_back({{4.0 * x, 4.0 * y, 0.0}, up});
  }
  return probes;
}

struct Errors {
  double rms = 0.0, rms_bound = 0.0;  // relative to the exact light
  double greatest_bound = 0.0;
  int exceeded = 0;
};

Errors errors(const TracedScene& room, const std::vector<Probe>& probes, int rays,
              double accuracy) {
  ProbeBounds bounds{.accuracy = accuracy};
  const BandArray E = probe_irradiance(room.scene, room.caster, room.direct_light, room.solution,
                                       probes, {.rays = rays}, &bounds);
  EXPECT_EQ(bounds.missed, 0);
  Errors found;
  const auto count = static_cast<double>(probes.size());
  for (std::size_t i = 0; i < probes.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    const double exact = opening_lux(room, probes[i]);
    const double error = luminous(room.scene.bands, E.row(row).transpose()) / exact - 1.0;
    const double bound = bounds.lux_within[row] / exact;
    found.rms += error * error / count;
    found.rms_bound += bound * bound / count;
    found.greatest_bound = std::max(found.greatest_bound, bound);
    found.exceeded += std::abs(error) > bound ? 1 : 0;
  }
  found.rms = std::sqrt(found.rms);
  found.rms_bound = std::sqrt(found.rms_bound);
  return found;
}

class SureGatherOf : public ::testing::TestWithParam<double> {};

TEST_P(SureGatherOf, SkyIsWithinItsBoundOfTheFormFactor) {
  const double accuracy = GetParam();
  const auto room = roofless_room();
  const Errors found = errors(*room, floor_probes(10), 64, accuracy);
  // Exact light is below the bounded one by up to the bound itself.
  EXPECT_LE(found.greatest_bound, accuracy * (1.0 + 2.0 * accuracy));
  // 5 of 100 are expected with a standard deviation of sqrt(100 * 0.05 * 0.95) = 2.2; 12 are more
  // by three of them.
  EXPECT_LE(found.exceeded, 12);
  // A bound that says something: Student's t of 2.5 and the deviation of an estimate from 8 sets,
  // sqrt(1 / 14) of it, make 2.6 times the error.
  EXPECT_LE(found.rms_bound, 4.0 * found.rms);
}

INSTANTIATE_TEST_SUITE_P(Accuracies, SureGatherOf, ::testing::Values(0.02, 0.005, 0.001));

TEST(SureGather, RaysToTheSkyFollowTheHemispheres) {
  const auto room = roofless_room();
  const std::vector<Probe> probes = floor_probes(8);
  const double few = errors(*room, probes, 64, 0.0).rms,
               many = errors(*room, probes, 4096, 0.0).rms;
  // 64 times the rays leave 64^(-3/4) = 1/22 of the noise of stratified rays, 1/8 of that of
  // others.
  EXPECT_LT(many, few / 8.0);
}

TEST(SureGather, DefaultLeavesHalfAPercentOfTheSky) {
  // 8 sets of 1024 rays. A straight edge of the opening crosses at most 2 sqrt(n) of n cells, each
  // off by 0.3 in the root mean square: 0.3 sqrt(2 * 32) / 1024 / sqrt(8) = 0.08 % for one edge of
  // a square, twice that for four; cells follow Hilbert's curve, whose pieces are less compact than
  // squares: three times that.
  const auto room = roofless_room();
  EXPECT_LT(errors(*room, floor_probes(8), 1024, 0.0).rms, 0.005);
}

TEST(SureGather, OfADarkPointIsUnknown) {
  const auto room = roofless_room();
  ProbeBounds bounds;
  const std::vector<Probe> downwards = {{{2, 2, 1}, -up}};
  probe_irradiance(room->scene, room->caster, room->direct_light, room->solution, downwards,
                   {.rays = 64}, &bounds);
  EXPECT_TRUE(std::isnan(bounds.lux_within[0]));
}

TEST(SureGather, EvenIndirectLightHasNoNoise) {
  // In a closed room every ray ends on radiosity 2, so sets differ by float rounding alone.
  TracedScene lit(SceneBuilder()
                      .box({.reflectance = 0.5f, .exitance = 1.0f, .one_sided = true}, {0, 0, 0},
                           {2, 2, 2}, true)
                      .build());
  lit.set_indirect([](const auto&) { return 2.0f; });
  ProbeBounds bounds{.accuracy = 0.001};
  const std::vector<Probe> probes = {{{0.3, 0.4, 0}, up}, {{1, 1, 1}, up}};
  const BandArray E = probe_irradiance(lit.scene, lit.caster, lit.direct_light, lit.solution,
                                       probes, {.rays = 64}, &bounds);
  constexpr double rounding = 1e-6;
  for (Eigen::Index i = 0; i < 2; ++i) {
    EXPECT_NEAR(E(i, 0), 2.0, 2.0 * rounding);
    EXPECT_LT(bounds.lux_within[i],
              rounding * luminous(lit.scene.bands, constant_spectrum(lit.scene.bands, 2.0f)));
  }
  EXPECT_EQ(bounds.missed, 0);
}

TEST(SureGather, BoundsTheErrorOfTheLightThatItReads) {
  // In a closed room of reflectance 0.5 whose irradiance is 2 and off by 3 % everywhere, a gather
  // is off by half of that, and has no noise.
  TracedScene lit(SceneBuilder()
                      .box({.reflectance = 0.5f, .exitance = 1.0f, .one_sided = true}, {0, 0, 0},
                           {2, 2, 2}, true)
                      .build());
  lit.set_indirect([](const auto&) { return 2.0f; });
  const int elements = lit.caster.mesh().element_count();
  constexpr float error = 0.03f;
  lit.solution.interpolation_error = Eigen::ArrayXf::Constant(elements, error);
  lit.solution.gather_noise = Eigen::ArrayXf::Zero(elements);
  ProbeBounds bounds;
  const std::vector<Probe> probes = {{{0.3, 0.4, 0}, up}, {{1, 1, 1}, up}};
  probe_irradiance(lit.scene, lit.caster, lit.direct_light, lit.solution, probes, {.rays = 64},
                   &bounds);
  const double lux = luminous(lit.scene.bands, constant_spectrum(lit.scene.bands, 2.0f));
  constexpr double rounding = 1e-6;
  for (Eigen::Index i = 0; i < 2; ++i) {
    EXPECT_GT(bounds.read_within[i], 0.0);
    EXPECT_NEAR(bounds.lux_within[i], bounds.read_within[i], rounding * lux);
    // One to two standard deviations of a common error of 0.5 * 3 %.
    EXPECT_GE(bounds.lux_within[i], (1.0 - rounding) * 0.5 * error * lux);
    EXPECT_LE(bounds.lux_within[i], (1.0 + rounding) * error * lux);
  }
}

TEST(SureGather, KnowsThatFewRaysMayMissLight) {
  // A point inside a shaft of 0.1 m x 0.1 m and 3 m depth sees the bright ceiling in 1 of 2800
  // directions, which 64 rays in each set do not find; walls of the shaft are black.
  SceneBuilder builder;
  builder.square({.reflectance = 0.5f}, {0, 0, 3}, -up, 0.5);
  const double h = 0.05;
  const Loop foot = {{-h, -h, 0}, {h, -h, 0}, {h, h, 0}, {-h, h, 0}};
  for (std::size_t i = 0; i < 4; ++i) {
    const Vector3d a = foot[i], b = foot[(i + 1) % 4];
    builder.polygon({}, {a, a + 2.9 * up, b + 2.9 * up, b});
  }
  TracedScene lit(builder.build());
  lit.set_indirect([](const auto&) { return 2.0f; });
  ProbeBounds bounds;
  const std::vector<Probe> probes = {{{0.01, 0.02, 0.01}, up}};
  const BandArray E = probe_irradiance(lit.scene, lit.caster, lit.direct_light, lit.solution,
                                       probes, {.rays = 64}, &bounds);
  // Radiosity 1 times the form factor of the opening, (0.1 m)^2 / (pi (3 m)^2) at least.
  const double least = 0.01 / (pi * 9.0);
  const double lux = luminous(lit.scene.bands, constant_spectrum(lit.scene.bands, 1.0f));
  const double found = luminous(lit.scene.bands, E.row(0).transpose());
  EXPECT_LT(found, 0.1 * lux);
  EXPECT_GT(found + bounds.lux_within[0], least * lux);
}

TEST(SureGather, HasTheSameBitsOnAnyNumberOfThreads) {
  const auto room = roofless_room();
  const std::vector<Probe> probes = floor_probes(3);
  const auto E = [&](int threads) {
    const ThreadLimit limit(threads);
    ProbeBounds bounds{.accuracy = 0.01};
    return probe_irradiance(room->scene, room->caster, room->direct_light, room->solution, probes,
                            {.rays = 64}, &bounds);
  };
  EXPECT_TRUE((E(1) == E(3)).all());
}

}  // namespace
}  // namespace lightwell::sure_gather_test
