#include "raytrace/shading/pixel_gather.h"

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <cmath>
#include <optional>

#include "tests/radiosity/gather/test_plates.h"

namespace lightwell::pixel_gather_test {
namespace {

// Gathers between two long plates, 2 mm apart.
class BetweenPlates {
 public:
  static constexpr double gap = 0.002;
  static constexpr int rays = 256, fewest = 8;

  BetweenPlates() {
    solution_.direct_irradiance = BandArray::Zero(plates_.mesh.vertex_count(), 3);
    solution_.indirect_irradiance = BandArray::Constant(plates_.mesh.vertex_count(), 3, test::B0);
    gather_.emplace(plates_.scene, plates_.caster, plates_.light, solution_, rays, fewest);
  }

  // Irradiance at x by `share` of the rays, over the truth, with other rays each time.
  Eigen::ArrayXd over_truth(double x, float share, int replicas) const {
    const ShadingPoint at{.position = {x, 0.0, 0.0},
                          .normal = Eigen::Vector3d::UnitZ(),
                          .smooth_normal = Eigen::Vector3d::UnitZ(),
                          .facet = test::desk_facet};
    Eigen::ArrayXd found(replicas);
    for (int i = 0; i < replicas; ++i) {
      found[i] = double{gather_->indirect_irradiance(plates_.caster, at,
                                                     static_cast<std::uint64_t>(i), share)[0]};
    }
    return found / test::between_long_plates(x, gap);
  }

 private:
  test::Plates plates_{gap};
  RadiositySolution solution_{.bands = plates_.scene.bands};
  std::optional<PixelGather> gather_{};
};

double deviation_of(const Eigen::ArrayXd& values) {
  return std::sqrt((values - values.mean()).square().sum() /
                   static_cast<double>(values.size() - 1));
}

}  // namespace

// Irradiance deep in a gap has a small deviation with a few hundred rays.
TEST(PixelGather, DeepInAGapIsKnownByAFewHundredRays) {
  constexpr int replicas = 64;
  constexpr double x = 0.4 * test::plate_width;
  const Eigen::ArrayXd found = BetweenPlates().over_truth(x, 1.0f, replicas);
  // Cosine-distributed rays alone bring B0 or nothing and deviate by as much as the light at least.
  ASSERT_GT(std::sqrt(double{test::B0} /
                      (BetweenPlates::rays * test::between_long_plates(x, BetweenPlates::gap))),
            1.0);
  EXPECT_LT(deviation_of(found), 0.5);
  // Four standard errors; 1 % for the plates' finite length.
  EXPECT_NEAR(found.mean(), 1.0, 4.0 * deviation_of(found) / std::sqrt(replicas) + 0.01);
}

// An eighth and a thirtieth of the rays get out 2.3 and 5.2 mm behind the brink, so that chance
// decides whether a gather of 8 rays aims. The light has no part in that, or it would be 4 % too
// bright at the first place.
TEST(PixelGather, NearTheBrinkOfAGapHasNoBias) {
  constexpr int replicas = 8192;
  const BetweenPlates plates;
  for (const double x : {0.0023, 0.0052}) {
    const Eigen::ArrayXd found =
        plates.over_truth(x, 1.0f * BetweenPlates::fewest / BetweenPlates::rays, replicas);
    EXPECT_NEAR(found.mean(), 1.0, 4.0 * deviation_of(found) / std::sqrt(replicas) + 0.01) << x;
  }
}

}  // namespace lightwell::pixel_gather_test
