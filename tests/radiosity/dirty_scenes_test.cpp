// Dirty variants of small models are solved, and their energy adds up.
#include <gtest/gtest.h>

#include <cmath>

#include "mesh/cleaning/planar_regions.h"
#include "radiosity/solve.h"
#include "tests/mesh/dirty_variants.h"

namespace lightwell::dirty_scenes_test {
namespace {

using namespace lightwell::test;

constexpr int lamp = 2;  // the material of read_model()

class DirtyScenes : public testing::TestWithParam<int> {};

// All emitted light is absorbed, escapes or is not yet shot. What rows of form factors lose in
// surfaces that cut each other counts as escaped.
TEST_P(DirtyScenes, AreSolvedAndKeepTheBalanceOfEnergy) {
  constexpr std::uint32_t variants = 5;
  SolveOptions options;
  options.mesh.auto_patch_count = 80;
  options.form_factors.rays_per_patch = 64;
  options.gather.rays = 32;
  options.gather.shadows = {.min_rays = 4, .max_rays = 16, .sky_rays = 16};
  options.error_points = 16;
  options.refine.tolerance = 0.0f;
  for (std::uint32_t k = 0; k < variants; ++k) {
    const std::uint32_t seed = 1000 + variants * static_cast<std::uint32_t>(GetParam()) + k;
    std::string defects;
    const Scene raw = read_model(dirty_variant(furnished(GetParam()), seed, &defects));
    SCOPED_TRACE(testing::Message() << "seed " << seed << ": " << defects);
    Scene scene = merge_planar_regions(raw);
    if (scene.surfaces.empty()) continue;  // all cut off
    if (!gives_light(scene)) scene.surfaces.front().material = lamp;
    SolvedScene solved;
    ASSERT_NO_THROW(solved = solve_scene(scene, options));
    EXPECT_TRUE(solved.solution.patch_radiosity.isFinite().all());
    const EnergyBalance& energy = solved.solution.energy;
    EXPECT_GT(energy.emitted, 0.0);
    // Sums over a few thousand patches in single precision.
    EXPECT_NEAR((energy.absorbed + energy.escaped + energy.unshot) / energy.emitted, 1.0, 1e-4);
  }
}

INSTANTIATE_TEST_SUITE_P(Models, DirtyScenes, testing::Range(0, furnished_models));

}  // namespace
}  // namespace lightwell::dirty_scenes_test
