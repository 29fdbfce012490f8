// The noise of gathers, as the solution estimates it.
#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "mesh/build_patches.h"
#include "radiosity/refine/gather_noise.h"
#include "radiosity/solve.h"
#include "tests/radiosity/test_scenes.h"

namespace lightwell::gather_noise_test {
namespace {

// A room whose wall x0 is bright, seen from the floor.
struct Room {
  Scene scene = [] {
    Scene made;
    const int grey = test::add_material(made, test::diffuse(made.bands, 0.5f));
    const int bright = test::add_material(made, test::diffuse(made.bands, 0.5f, 1.0f));
    test::add_box(made, {0, 0, 0}, {2, 2, 2}, {bright, grey, grey, grey, grey, grey}, true);
    return made;
  }();
  PatchMesh mesh = build_patches(scene, {.max_patch_size = 0.25});
  ElementCaster caster{mesh};
  DirectLight direct_light{scene, mesh};

  // Radiosity at vertices: `wall` on x0, `rest` elsewhere.
  BandArray radiosity(float wall, float rest) const {
    BandArray B = BandArray::Constant(mesh.vertex_count(), 3, rest);
    for (int e = 0; e < mesh.element_count(); ++e) {
      if (mesh.facet[e] != 0) continue;
      for (int c = 0; c < mesh.corner_count(e); ++c) B.row(mesh.corners[e][c]) = wall;
    }
    return B;
  }
  GatheredIrradiance gather(const BandArray& B, int rays, std::uint64_t replica) const {
    const GatherPoint point{.position = {0.7, 0.9, 0.0}, .normal = {0, 0, 1}, .facet = 4};
    return gather_irradiance({scene, caster, direct_light}, B, std::array{point},
                             {.rays = rays, .replica = replica});
  }
};

TEST(GatherNoise, IsWhatIndependentGathersDifferBy) {
  const Room room;
  const BandArray B = room.radiosity(1.0f, 0.2f);
  for (const int rays : {64, 256, 4096}) {
    constexpr int replicas = 400;
    double sum = 0.0, squares = 0.0, estimated = 0.0;
    for (int i = 0; i < replicas; ++i) {
      const GatheredIrradiance E = room.gather(B, rays, static_cast<std::uint64_t>(i));
      sum += E.indirect(0, 0);
      squares += std::pow(double{E.indirect(0, 0)}, 2);
      estimated += E.variance[0] / replicas;
    }
    const double mean = sum / replicas;
    const double variance = squares / replicas - mean * mean;
    std::printf("%d rays: noise %.2e, estimated %.2e\n", rays, std::sqrt(variance),
                std::sqrt(estimated));
    // The variance of 400 replicas is known to 7 %; the bounds allow three times that. The error of
    // a stratified set falls with a power of the rays between 1/2 and 1, and halves are stratified
    // less well than the whole, so the estimate from their difference is up to twice the variance.
    EXPECT_GT(estimated, 0.79 * variance);
    EXPECT_LT(estimated, 2.0 * 1.21 * variance);
  }
}

TEST(GatherNoise, IsNothingWhereAllThatIsSeenIsAlike) {
  const Room room;
  const GatheredIrradiance E = room.gather(room.radiosity(0.7f, 0.7f), 256, 0);
  EXPECT_NEAR(E.indirect(0, 0), 0.7f, 1e-6);
  EXPECT_LT(E.variance[0], 1e-12);  // weights of corners add up to 1 but for float rounding
}

// A bilinear mean of four independent errors has 4/9 of their variance, and the light is twice the
// square root of it here. Results differ from that by the rounding of float to a few ulp.
TEST(GatherNoise, OfElementsIsThatOfTheirVertices) {
  const Room room;
  const PatchMesh& mesh = room.mesh;
  const BandArray E = BandArray::Constant(mesh.vertex_count(), 3, 0.5f);
  const auto noise_of = [&](const Eigen::ArrayXf& variance) {
    return gather_noise(mesh, E, variance);
  };
  const auto expected = static_cast<float>(std::sqrt(4.0 / 9.0 * 1e-4) / 0.5);
  const Eigen::ArrayXf alike = noise_of(Eigen::ArrayXf::Constant(mesh.vertex_count(), 1e-4f));
  EXPECT_FLOAT_EQ(alike.minCoeff(), expected);
  EXPECT_FLOAT_EQ(alike.maxCoeff(), expected);

  // Elements beside a noisy one share some of its vertices, each of which counts a quarter.
  Eigen::ArrayXf variance = Eigen::ArrayXf::Zero(mesh.vertex_count());
  for (int c = 0; c < mesh.corner_count(0); ++c) variance[mesh.corners[0][c]] = 1e-4f;
  const Eigen::ArrayXf beside = noise_of(variance);
  int sharing = 0;
  for (int e = 0; e < mesh.element_count(); ++e) {
    int noisy = 0;
    for (int c = 0; c < mesh.corner_count(e); ++c) noisy += variance[mesh.corners[e][c]] > 0.0f;
    EXPECT_FLOAT_EQ(beside[e], static_cast<float>(expected * std::sqrt(noisy / 4.0)));
    sharing += 0 < noisy && noisy < 4 ? 1 : 0;
  }
  EXPECT_GT(sharing, 0);
}

TEST(GatherNoise, OfVerticesIsThatOfTheirRays) {
  const Room room;
  const Eigen::ArrayXf ones = Eigen::ArrayXf::Ones(room.mesh.vertex_count());
  const Eigen::ArrayXf variance = vertex_variance(room.mesh, 64.0f * ones, 16.0f * ones);
  // A mean over equal values, to the rounding of float.
  EXPECT_FLOAT_EQ(variance.minCoeff(), 4.0f);
  EXPECT_FLOAT_EQ(variance.maxCoeff(), 4.0f);
}

TEST(GatherNoise, OfASolutionFallsWithRays) {
  const Room room;
  SolveOptions options{.mesh = {.max_patch_size = 0.5}, .refine = {.tolerance = 0.05}};
  const auto noise = [&](int rays) {
    options.gather.rays = rays;
    const SolvedScene solved = solve_scene(room.scene, options);
    const RadiositySolution& s = solved.solution;
    EXPECT_EQ(s.gather_noise.size(), solved.mesh.element_count());
    EXPECT_EQ(error_bound(s).size(), solved.mesh.element_count());
    EXPECT_TRUE((error_bound(s) >= 2.0f * s.interpolation_error).all());
    return rms_noise(solved.mesh, s.gather_noise);
  };
  // Noise falls by 16^(1/2) for plain random rays, and by 16 at most.
  const double few = noise(64), many = noise(1024);
  EXPECT_GT(few, 4.0 * many);
  EXPECT_LT(few, 16.0 * many);
}

}  // namespace
}  // namespace lightwell::gather_noise_test
