// Neighbours that even out the noise of their gathers.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "mesh/build_patches.h"
#include "radiosity/refine/even_out_noise.h"
#include "tests/radiosity/test_scenes.h"

namespace lightwell::even_out_noise_test {
namespace {

// A square of 2 m whose elements are squares of 1/16 m.
PatchMesh square() {
  Scene scene;
  const int grey = test::add_material(scene, test::diffuse(scene.bands, 0.5f));
  test::add_polygon(scene, "floor", grey, {{0, 0, 0}, {2, 0, 0}, {2, 2, 0}, {0, 2, 0}});
  return build_patches(scene, {.max_patch_size = 0.5, .elements_per_patch_edge = 8});
}

// Light of `of_place` with normal noise of standard error `noise`, the same in the 3 bands.
template <class Light>
BandArray noisy(const PatchMesh& mesh, const Light& of_place, double noise) {
  std::mt19937 random(1);
  std::normal_distribution<double> error(0.0, noise);
  BandArray E(mesh.vertex_count(), 3);
  for (int v = 0; v < mesh.vertex_count(); ++v) {
    E.row(v) = static_cast<float>(of_place(mesh.position(v)) + error(random));
  }
  return E;
}

double power(const PatchMesh& mesh, const BandArray& E) {
  const std::vector<double> area = vertex_areas(mesh);
  double sum = 0.0;
  for (int v = 0; v < mesh.vertex_count(); ++v) sum += area[v] * double{E(v, 0)};
  return sum;
}

template <class Light>
double rms_error(const PatchMesh& mesh, const BandArray& E, const Light& of_place) {
  double sum = 0.0;
  for (int v = 0; v < mesh.vertex_count(); ++v) {
    sum += std::pow(double{E(v, 0)} - of_place(mesh.position(v)), 2);
  }
  return std::sqrt(sum / mesh.vertex_count());
}

// Sums of floats: each of 33 x 33 vertices is rounded by up to 2^-24 of its value a few times.
constexpr double sum_rounding = 8 * 0x1p-24;

TEST(EvenOutNoise, NoiseFallsAndThePowerStays) {
  const PatchMesh mesh = square();
  const auto slope = [](const Eigen::Vector3d& at) { return 1.0 + 0.2 * at.x(); };
  constexpr double noise = 0.1;
  const BandArray before = noisy(mesh, slope, noise);
  BandArray after = before;
  Eigen::ArrayXf variance = Eigen::ArrayXf::Constant(mesh.vertex_count(), noise * noise);
  even_out_noise(mesh, {}, 3, after, variance);
  EXPECT_NEAR(power(mesh, after), power(mesh, before), sum_rounding * power(mesh, before));
  // Without any doubt the share s is 8/9 and leaves 1/3 of the noise. Doubts of the median, which
  // is that of 9 squares, are of the size of the noise for some vertices and nothing for most.
  const double left = rms_error(mesh, after, slope);
  std::printf("noise %.3f left of %.3f, estimated %.3f\n", left, noise,
              std::sqrt(double{variance.mean()}));
  EXPECT_LT(left, 2.0 / 3.0 * noise);
  // The remaining variance is as the values err: 1089 values know it to 2 sqrt(2 / 1089) = 9 %, and
  // correlation between shares and values adds as much.
  EXPECT_NEAR(double{variance.mean()}, left * left, 0.3 * left * left);
}

TEST(EvenOutNoise, EdgesOfLightStay) {
  const PatchMesh mesh = square();
  const auto step = [](const Eigen::Vector3d& at) { return at.x() < 1.0 ? 1.0 : 3.0; };
  constexpr double noise = 0.02;
  BandArray E = noisy(mesh, step, noise);
  Eigen::ArrayXf variance = Eigen::ArrayXf::Constant(mesh.vertex_count(), noise * noise);
  even_out_noise(mesh, {}, 3, E, variance);
  // Differences across the edge are a hundred times the noise. No vertex beside it moves by as much
  // as its noise, three standard errors of which may have been there before.
  for (int v = 0; v < mesh.vertex_count(); ++v) {
    EXPECT_NEAR(double{E(v, 0)}, step(mesh.position(v)), 4.0 * noise) << v;
  }
}

TEST(EvenOutNoise, AnOutlierIsSpreadAndNotLost) {
  const PatchMesh mesh = square();
  const auto even = [](const Eigen::Vector3d&) { return 1.0; };
  constexpr double noise = 0.1;
  BandArray E = noisy(mesh, even, noise);
  int middle = 0;
  for (int v = 0; v < mesh.vertex_count(); ++v) {
    if ((mesh.position(v) - Eigen::Vector3d(1, 1, 0)).norm() < 1e-9) middle = v;
  }
  E.row(middle) = 2.0f;
  const double before = power(mesh, E);
  Eigen::ArrayXf variance = Eigen::ArrayXf::Constant(mesh.vertex_count(), noise * noise);
  even_out_noise(mesh, {}, 3, E, variance);
  EXPECT_NEAR(power(mesh, E), before, sum_rounding * before);
  // Without any doubt the outlier keeps a ninth of its excess. Its own square makes the neighbours
  // doubtful: (10 noise / 8)^2 / 0.455 = 3.4 noise^2 beyond their own, which leaves a share of 1 /
  // (1
  // + 1 / 8 + 3.4) = 0.22 or more, as most medians are less.
  EXPECT_LT(E(middle, 0), 2.0f - 0.22f);
}

TEST(EvenOutNoise, WhatHasNoNoiseStays) {
  const PatchMesh mesh = square();
  const auto even = [](const Eigen::Vector3d&) { return 1.0; };
  const BandArray before = noisy(mesh, even, 0.1);
  BandArray after = before;
  Eigen::ArrayXf variance = Eigen::ArrayXf::Zero(mesh.vertex_count());
  even_out_noise(mesh, {}, 3, after, variance);
  EXPECT_TRUE((after == before).all());
  EXPECT_TRUE((variance == 0.0f).all());
}

// An interpolated vertex between two ends has their mean, and its area counts for them.
TEST(EvenOutNoise, InterpolatedVerticesFollowTheirEnds) {
  const PatchMesh mesh = square();
  const auto even = [](const Eigen::Vector3d&) { return 1.0; };
  BandArray E = noisy(mesh, even, 0.1);
  const auto& corners = mesh.corners[mesh.element_count() / 2];
  const VertexPrediction between{
      .at = {.vertex = corners[0], .ends = {corners[1], corners[3], -1, -1}},
      .is_interpolated = true};
  interpolate_vertices({&between.at, 1}, E);
  const double before = power(mesh, E);
  Eigen::ArrayXf variance = Eigen::ArrayXf::Constant(mesh.vertex_count(), 0.01f);
  even_out_noise(mesh, {&between, 1}, 3, E, variance);
  EXPECT_NEAR(power(mesh, E), before, sum_rounding * before);
  EXPECT_FLOAT_EQ(E(corners[0], 0), 0.5f * (E(corners[1], 0) + E(corners[3], 0)));
}

// Each vertex lies between the two before it, so that vertex i has as many paths to the first two
// as Fibonacci's number i. All of them stand for these two.
TEST(EvenOutNoise, LongChainsOfInterpolatedVerticesAreShort) {
  const PatchMesh mesh = square();
  const auto even = [](const Eigen::Vector3d&) { return 1.0; };
  BandArray E = noisy(mesh, even, 0.1);
  std::vector<VertexPrediction> chain;
  for (int v = 2; v < mesh.vertex_count(); ++v) {
    chain.push_back({.at = {.vertex = v, .ends = {v - 1, v - 2, -1, -1}}, .is_interpolated = true});
    interpolate_vertices({&chain.back().at, 1}, E);
  }
  const double before = power(mesh, E);
  Eigen::ArrayXf variance = Eigen::ArrayXf::Constant(mesh.vertex_count(), 0.01f);
  even_out_noise(mesh, chain, 3, E, variance);
  EXPECT_NEAR(power(mesh, E), before, sum_rounding * before);
}

}  // namespace
}  // namespace lightwell::even_out_noise_test
