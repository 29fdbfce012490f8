#include "scene/sky_patch_means.h"

#include <gtest/gtest.h>

#include <numbers>

namespace lightwell::sky_patch_means_test {
namespace {

using std::numbers::pi;

const SkyPatches patches(2, Eigen::Vector3d::UnitZ(), Eigen::Vector3d::UnitY());

Sky sky_of(SkyKind kind) {
  return {.up = Eigen::Vector3d::UnitZ(),
          .north = Eigen::Vector3d::UnitY(),
          .kind = kind,
          .scale = Spectrum::Ones(1)};
}

TEST(SkyPatchMeans, OfAnEvenSkyAreItsRadiance) {
  const SkyPatchMeans means(patches);
  EXPECT_EQ((means.of(sky_of(SkyKind::gradation)) - 1.0).abs().maxCoeff(), 0.0);
  // pi sr of open ground, as sums of 577 numbers in double precision.
  EXPECT_NEAR(means.on_ground().sum(), pi, 1e-12);
}

// int (1 + 2 cos Z) / 3 cos Z dw = 7 pi / 9 (Moon & Spencer 1942). Products of means over patches
// that are H = 90 / 14.5 degrees high miss the covariance of both factors, H^2 / 12 times int 2/3
// sin^2 Z dw = 8 pi / 9. The midpoint rule over steps h of 5 degrees at most is off by h^2 / 24 of
// the second derivative, below 1, over pi.
TEST(SkyPatchMeans, OfTheOvercastSkyLightOpenGroundAsItsIntegral) {
  const SkyPatchMeans means(patches);
  const double E = (means.of(sky_of(SkyKind::overcast)) * means.on_ground()).sum();
  const double H = 90.0 / 14.5 * pi / 180.0, h = 5.0 * pi / 180.0;
  EXPECT_NEAR(E, 7.0 * pi / 9.0 - H * H / 12.0 * 8.0 * pi / 9.0, h * h / 24.0 * pi);
}

}  // namespace
}  // namespace lightwell::sky_patch_means_test
