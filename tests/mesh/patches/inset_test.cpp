#include "mesh/patches/inset.h"

#include <gtest/gtest.h>

#include "mesh/build_patches.h"
#include "tests/mesh/mesh_scenes.h"

namespace lightwell::inset_test {
namespace {

using namespace lightwell::test;
using Eigen::Vector3d;

TEST(Inset, IsAShareOfTheWayButNotLessThanTheLeast) {
  const Vector3d point(1, 2, 3), center(4, 6, 3);  // 5 m apart
  const auto length = [&](double share, double least) {
    return inset(point, center, share, least).norm();
  };
  // Exact but for the rounding of norms.
  EXPECT_DOUBLE_EQ(length(0.02, 0.05), 0.1);
  EXPECT_DOUBLE_EQ(length(0.02, 0.25), 0.25);
  EXPECT_DOUBLE_EQ(length(0.02, 100.0), 2.5) << "half of the way";
  EXPECT_EQ(inset(point, point, 0.02, 0.1), Vector3d::Zero());
  EXPECT_TRUE(inset(point, center, 0.02, 0.05).isApprox(0.02 * (center - point)));
}

// Single precision has 24 bits, so a coordinate h is rounded by up to h 2^-24, half of epsilon().
TEST(Inset, LeastIsBeyondTheRoundingOfTheMesh) {
  for (const double scale : {1e-3, 1.0, 1e4}) {
    Scene scene = empty_scene();
    add_polygon(scene, "floor",
                {{0, 0, 0}, {3 * scale, 0, 0}, {3 * scale, 4 * scale, 0}, {0, 4 * scale, 0}});
    const double least = least_inset(build_patches(scene, {.max_patch_size = scale}));
    const double rounding = 2.5 * scale * 0x1p-24;
    EXPECT_DOUBLE_EQ(least, 32.0 * rounding);
  }
}

}  // namespace
}  // namespace lightwell::inset_test
