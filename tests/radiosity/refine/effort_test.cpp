#include "radiosity/refine/effort.h"

#include <gtest/gtest.h>

#include "mesh/build_patches.h"
#include "radiosity/solve.h"
#include "tests/radiosity/two_lamps.h"

namespace lightwell::effort_test {
namespace {

TEST(Effort, NoTargetChangesNothing) {
  EXPECT_EQ(form_factor_rays(0.0, 512), 512);
  EXPECT_EQ(patch_count_for(0.0, 1600), 1600);
}

TEST(Effort, LooseTargetsTakeLess) {
  EXPECT_EQ(form_factor_rays(0.0025, 512), 512);
  EXPECT_EQ(form_factor_rays(0.005, 512), 256);
  EXPECT_EQ(form_factor_rays(0.0125, 512), 128);  // 102.4, to a power of two
  EXPECT_EQ(form_factor_rays(0.5, 512), 64);
  EXPECT_EQ(patch_count_for(0.01, 1600), 1600);
  EXPECT_EQ(patch_count_for(0.02, 1600), 800);
  EXPECT_EQ(patch_count_for(0.5, 1600), 600);
}

// The error of stratified rays falls with the power 2/3 of their number: 8 times as many rays leave
// a quarter. Five to seven eighths of a power of two stratify nearly as well as the power itself.
TEST(Effort, RaysFollowTheNoise) {
  EXPECT_EQ(rays_for_noise(128, 0.04, 0.01), 1024);
  EXPECT_EQ(rays_for_noise(128, 0.041, 0.01), 1280);  // 1063
  EXPECT_EQ(rays_for_noise(128, 0.050, 0.01), 1536);  // 1431
  EXPECT_EQ(rays_for_noise(128, 0.053, 0.01), 1792);  // 1562
  EXPECT_EQ(rays_for_noise(128, 0.059, 0.01), 2048);  // 1834
  EXPECT_EQ(rays_for_noise(128, 0.0, 0.01), 128);
  EXPECT_EQ(rays_for_noise(1 << 15, 1.0, 0.01), 1 << 15);
}

// Given numbers that are lower than those for the accuracy are kept.
TEST(Effort, NeverTakesMoreThanIsAskedFor) {
  EXPECT_EQ(form_factor_rays(0.001, 512), 512);
  EXPECT_EQ(form_factor_rays(0.5, 32), 32);
  EXPECT_EQ(patch_count_for(0.001, 1600), 1600);
  EXPECT_EQ(patch_count_for(0.5, 100), 100);
}

TEST(Effort, EstimateTakesMorePointsAndRaysWhereTheyAreCheap) {
  constexpr int asked = 512;
  EXPECT_EQ(estimate_points(asked, 6000), 512);
  EXPECT_EQ(estimate_points(asked, 32768), 1024);  // a 32nd
  EXPECT_EQ(estimate_points(asked, 32767), 512);
  EXPECT_EQ(estimate_points(asked, 1000000), 4096);  // eight times at most
  EXPECT_EQ(estimate_points(0, 1000000), 0);         // no estimate is wanted
  EXPECT_EQ(estimate_rays(1024, 6000, asked), 2048);
  EXPECT_EQ(estimate_rays(1024, 16384, asked), 4096);  // 4 x 512 are an eighth of the vertices
  EXPECT_EQ(estimate_rays(1024, 16383, asked), 2048);
  EXPECT_EQ(estimate_rays(64, 8, asked), 256);  // the fewest
}

TEST(Effort, LooseAccuracySolvesWithFewerPatches) {
  const Scene scene = test::two_lamps();
  const auto patches = [&](double share) {
    SolveOptions options;
    options.accuracy = Accuracy{.share = share};
    return solve_scene(scene, options).mesh.patch_count();
  };
  EXPECT_LT(2 * patches(0.1), build_patches(scene, {.to_be_refined = true}).patch_count());
}

}  // namespace
}  // namespace lightwell::effort_test
