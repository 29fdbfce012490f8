#include "raytrace/shading/pixel_gather.h"

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <cmath>

#include "tests/radiosity/gather/test_plates.h"

namespace lightwell::pixel_gather_test {
namespace {

// Irradiance deep in a gap has a small deviation with a few hundred rays.
TEST(PixelGather, DeepInAGapIsKnownByAFewHundredRays) {
  constexpr double gap = 0.002, x = 0.4 * test::plate_width;
  const test::Plates plates(gap);
  RadiositySolution solution{.bands = plates.scene.bands};
  solution.direct_irradiance = BandArray::Zero(plates.mesh.vertex_count(), 3);
  solution.indirect_irradiance = BandArray::Constant(plates.mesh.vertex_count(), 3, test::B0);
  constexpr int rays = 256, replicas = 64;
  const PixelGather gather(plates.scene, plates.caster, plates.light, solution, rays, 8);
  const ShadingPoint at{.position = {x, 0.0, 0.0},
                        .normal = Eigen::Vector3d::UnitZ(),
                        .smooth_normal = Eigen::Vector3d::UnitZ(),
                        .facet = test::desk_facet};
  Eigen::ArrayXd found(replicas);
  for (int i = 0; i < replicas; ++i) {
    found[i] = double{
        gather.indirect_irradiance(plates.caster, at, static_cast<std::uint64_t>(i), 1.0f)[0]};
  }
  const double expected = test::between_long_plates(x, gap);
  const double deviation = std::sqrt((found - found.mean()).square().sum() / (replicas - 1));
  // Cosine-distributed rays alone bring B0 or nothing and deviate by as much as the light at least.
  ASSERT_GT(std::sqrt(double{test::B0} / (rays * expected)), 1.0);
  EXPECT_LT(deviation, 0.5 * expected);
  // Four standard errors; 1 % for the plates' finite length.
  EXPECT_NEAR(found.mean(), expected, 4.0 * deviation / std::sqrt(replicas) + 0.01 * expected);
}

}  // namespace
}  // namespace lightwell::pixel_gather_test
