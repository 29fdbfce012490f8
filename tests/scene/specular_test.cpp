#include "scene/specular.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

#include "scene/microfacet.h"
#include "scene/optics.h"
#include "scene/sampling.h"

namespace lightwell::specular_test {
namespace {

constexpr double degree = std::numbers::pi / 180.0;
const Eigen::Vector3d up = Eigen::Vector3d::UnitZ();

Eigen::Vector3d downwards(double degrees) {
  return {std::sin(degrees * degree), 0.0, -std::cos(degrees * degree)};
}

Material mirror(float alpha) {
  const Spectrum zero = Spectrum::Zero(3);
  return {.name = "mirror",
          .reflectance = zero,
          .specular = Spectrum::Constant(3, 0.7f),
          .specular_roughness = alpha,
          .emission = zero};
}

Material glass(float alpha, bool thin = false) {
  Material material = mirror(0.0f);
  material.specular.setZero();
  material.dielectric = Dielectric{.tint = Spectrum::Ones(3), .roughness = alpha, .thin = thin};
  return material;
}

ScatteringSample draw(const Material& material, const Eigen::Vector3d& direction, bool from_back,
                      int i) {
  static const SobolPoints points(1 << 14);
  const Eigen::Array4d u = points.point(i, 11).cast<double>();
  return sample_scattering(
      {.material = material, .direction = direction, .normal = up, .from_back = from_back},
      {.component = u[2],
       .u = u[0],
       .v = u[1],
       .key = random_key(5, static_cast<std::uint64_t>(i))});
}

TEST(RoughMirror, ReflectsItsShareAtEveryAngle) {
  for (const float alpha : {0.01f, 0.2f, 0.6f, 1.0f}) {
    for (const double degrees : {0.0, 30.0, 60.0, 85.0, 89.9}) {
      const Material material = mirror(alpha);
      for (int i = 0; i < 500; ++i) {
        const ScatteringSample sample = draw(material, downwards(degrees), false, i);
        EXPECT_GT(sample.direction.z(), 0.0);
        EXPECT_NEAR(sample.direction.norm(), 1.0, 1e-12);
        EXPECT_EQ(sample.weight[1], 0.7f);
        EXPECT_FALSE(sample.crosses);
      }
    }
  }
}

// Mean direction of single-scattering reflection: microfacets of density D cos, weighted by
// (1 / (4 cos_i cos_o)) G2 over the density of directions, D cos_m / (4 i.m), and divided by the
// sum of weights, since the lobe is normalised.
TEST(RoughMirror, HasTheLobeOfSingleScattering) {
  constexpr int count = 1 << 14;
  const SobolPoints points(count);
  for (const float alpha : {0.2f, 0.5f, 1.0f}) {
    for (const double degrees : {0.0, 45.0, 75.0}) {
      const Eigen::Vector3d in = -downwards(degrees);
      Eigen::Vector3d drawn = Eigen::Vector3d::Zero(), weighted = drawn;
      double weights = 0.0;
      for (int i = 0; i < count; ++i) {
        drawn += draw(mirror(alpha), -in, false, i).direction;
        const Eigen::Array4d u = points.point(i, 3).cast<double>();
        const double tan2 = double{alpha} * alpha * u[2] / (1.0 - u[2]);
        const double phi = 2.0 * std::numbers::pi * u[3];
        const double cos_m = 1.0 / std::sqrt(1.0 + tan2), sine = std::sqrt(tan2) * cos_m;
        const Eigen::Vector3d m(sine * std::cos(phi), sine * std::sin(phi), cos_m);
        const Eigen::Vector3d out = reflect(-in, m);
        if (!(in.dot(m) > 0.0) || !(out.z() > 0.0)) continue;
        const double G2 = 1.0 / (1.0 + ggx_lambda(in.z(), alpha) + ggx_lambda(out.z(), alpha));
        const double weight = G2 * in.dot(m) / (in.z() * cos_m);
        weights += weight;
        weighted += weight * out;
      }
      // Directions and weights have standard deviations of at most about 2: 2 / sqrt(count) = 0.016
      // each.
      EXPECT_LT((drawn / count - weighted / weights).norm(), 0.03) << alpha << " " << degrees;
    }
  }
}

TEST(RoughGlass, LosesNothingAndReflectsByFresnelWhereItIsNearlySmooth) {
  for (const double degrees : {0.0, 40.0, 70.0}) {
    for (const bool from_back : {false, true}) {
      constexpr int count = 4096;
      double reflected = 0.0;
      for (int i = 0; i < count; ++i) {
        const ScatteringSample sample = draw(glass(0.001f), downwards(degrees), from_back, i);
        EXPECT_EQ(sample.weight[0], 1.0f);
        EXPECT_EQ(sample.crosses, sample.direction.z() < 0.0);
        reflected += sample.crosses ? 0.0 : 1.0 / count;
      }
      const double R = fresnel_reflectance(std::cos(degrees * degree), from_back ? 1 / 1.5 : 1.5);
      // Samples are stratified, and the bound of R crosses few strata. Slopes of 0.001 change R by
      // 0.001 dR/dangle, which is below 0.01 at these angles; the critical angle is 41.8 degrees.
      EXPECT_NEAR(reflected, R, 0.01 + 1.0 / 64.0) << degrees << from_back;
    }
  }
}

// A lamp behind a surface that passes no light gives 0 in each band, and not an array without
// bands.
TEST(ScatteringWeight, IsZeroInAllBandsBehindOpaqueSurfaces) {
  Material coated = mirror(0.2f);
  coated.coat = Coat{.index_of_refraction = 1.5f};
  for (const Material& material : {mirror(0.0f), mirror(0.2f), coated}) {
    const Spectrum weight = scattering_weight(
        {.material = material, .direction = downwards(30.0), .normal = Eigen::Vector3d::UnitZ()},
        {.direction = -Eigen::Vector3d::UnitZ(), .crosses = true});
    ASSERT_EQ(weight.size(), material.specular.size());
    EXPECT_EQ(weight.maxCoeff(), 0.0f);
    EXPECT_EQ(weight.minCoeff(), 0.0f);
  }
}

TEST(RoughGlass, SpreadsMoreTheRougherItIs) {
  double last = 1.1;
  for (const float alpha : {0.0f, 0.1f, 0.3f, 0.8f}) {
    double straight = 0.0;
    int crossed = 0;
    for (int i = 0; i < 2000; ++i) {
      const ScatteringSample sample = draw(glass(alpha), downwards(0.0), false, i);
      straight += sample.crosses ? -sample.direction.z() : 0.0;
      crossed += sample.crosses ? 1 : 0;
    }
    EXPECT_LT(straight / crossed, last) << alpha;
    last = straight / crossed;
  }
  EXPECT_LT(last, 0.99);
}

// The integral of the density over all directions, in cells of equal solid angle, is 1, and the
// mean directions by density and by drawn directions agree.
TEST(RoughLobe, IsTheDensityOfWhatIsDrawn) {
  for (const Material& material : {mirror(0.4f), mirror(1.0f), glass(0.3f), glass(0.5f, true)}) {
    for (const bool from_back : {false, true}) {
      for (const double degrees : {10.0, 50.0, 75.0}) {
        const RoughLobe lobe(material, from_back);
        const SurfaceInteraction interaction{.material = material,
                                             .direction = downwards(degrees),
                                             .normal = up,
                                             .from_back = from_back};
        constexpr int steps = 400;
        double all = 0.0;
        Eigen::Vector3d expected = Eigen::Vector3d::Zero(), drawn = expected;
        for (int i = 0; i < steps; ++i) {
          const double z = -1.0 + 2.0 * (i + 0.5) / steps, r = std::sqrt(1.0 - z * z);
          for (int j = 0; j < steps; ++j) {
            const double phi = 2.0 * std::numbers::pi * (j + 0.5) / steps;
            const Eigen::Vector3d d(r * std::cos(phi), r * std::sin(phi), z);
            const double p =
                lobe.density(interaction, d) * 4.0 * std::numbers::pi / (steps * steps);
            all += p;
            expected += p * d;
          }
        }
        constexpr int count = 4096;
        for (int i = 0; i < count; ++i) {
          drawn += draw(material, downwards(degrees), from_back, i).direction / count;
        }
        // The table of 256 points, linear between 64 cosines, has an error of one percent, and so
        // have the cells, which the horizon cuts. Means of drawn directions have a standard
        // deviation of at most 1 / sqrt(4096).
        EXPECT_NEAR(all, 1.0, 0.02) << material.gloss_roughness() << from_back << degrees;
        EXPECT_LT((expected - drawn).norm(), 0.02 + 2.0 / 64.0)
            << material.gloss_roughness() << from_back << degrees;
      }
    }
  }
}

TEST(ThinPane, PassesStraightThroughWhateverItsIndex) {
  const Eigen::Vector3d d = downwards(50.0);
  for (const bool from_back : {false, true}) {
    const Material pane = glass(0.0f, true);
    const SmoothScattering lobes =
        smooth_scattering({.material = pane, .direction = d, .normal = up, .from_back = from_back});
    ASSERT_EQ(lobes.count, 2);
    EXPECT_LT((lobes.sample[1].direction - d).norm(), 1e-12);
    EXPECT_NEAR(lobes.sample[0].weight[0] + lobes.sample[1].weight[0], 1.0, 1e-6);
    EXPECT_NEAR(lobes.sample[0].weight[0], pane_reflectance(-d.z(), 1.5), 1e-6);
  }
}

TEST(ThinPane, LeavesWhatItsBodyPassesAtEveryAngle) {
  Material pane = glass(0.0f, true);
  pane.dielectric->transmissivity = Eigen::Array3f(0.25f, 0.7f, 1.0f);
  pane.dielectric->tint = Eigen::Array3f(0.9f, 1.0f, 0.5f);
  for (const double degrees : {0.0, 50.0, 80.0}) {
    for (const bool from_back : {false, true}) {
      const SurfaceInteraction interaction{
          .material = pane, .direction = downwards(degrees), .normal = up, .from_back = from_back};
      const SmoothScattering lobes = smooth_scattering(interaction);
      ASSERT_EQ(lobes.count, 2);
      const double R = pane_reflectance(std::cos(degrees * degree), 1.5);
      const Spectrum back = sample_scattering(interaction, {.component = 0.0}).weight;
      const Spectrum through = sample_scattering(interaction, {.component = 0.999}).weight;
      for (int k = 0; k < 3; ++k) {
        const PaneShares expected = pane_shares(std::cos(degrees * degree), 1.5,
                                                double{pane.dielectric->transmissivity[k]});
        const double passed = expected.passed * double{pane.dielectric->tint[k]};
        // A few products of floats of at most 1.
        EXPECT_NEAR(lobes.sample[0].weight[k], expected.reflected, 3e-7);
        EXPECT_NEAR(lobes.sample[1].weight[k], passed, 3e-7);
        // Samples are drawn with the probabilities R and 1 - R of a clear pane.
        EXPECT_NEAR(R * double{back[k]}, expected.reflected, 3e-7);
        EXPECT_NEAR((1.0 - R) * double{through[k]}, passed, 3e-7);
      }
    }
  }
}

// A roughness of 0.001 spreads light by a thousandth, and with it the shares, whose slope at 60
// degrees is below 1 per radian.
TEST(ThinPane, LeavesAsMuchIfItIsSlightlyRough) {
  Material smooth = glass(0.0f, true), rough = glass(0.001f, true);
  smooth.dielectric->transmissivity = rough.dielectric->transmissivity =
      Spectrum::Constant(3, 0.5f);
  const Eigen::Vector3d in = downwards(60.0);
  const SmoothScattering lobes =
      smooth_scattering({.material = smooth, .direction = in, .normal = up});
  double reflected = 0.0, passed = 0.0;
  constexpr int count = 1 << 14;
  for (int i = 0; i < count; ++i) {
    const ScatteringSample sample = draw(rough, in, false, i);
    (sample.crosses ? passed : reflected) += double{sample.weight[0]} / count;
  }
  // Microfacets lean by 0.001 to either side, and the side is chosen 2^14 times evenly: the spread
  // allows 0.005, and the choice less than 1 / sqrt(2^14) = 0.008.
  EXPECT_NEAR(reflected, double{lobes.sample[0].weight[0]}, 0.005);
  EXPECT_NEAR(passed, double{lobes.sample[1].weight[0]}, 0.008);
}

TEST(ThinPane, CrossingShareIsThatOfLightNotReflectedAlongTheNormal) {
  Material pane = glass(0.0f, true);
  pane.dielectric->tint.setConstant(0.8f);
  EXPECT_EQ(crossing_share(*pane.dielectric)[0], 0.8f);
  pane.dielectric->transmissivity = Spectrum::Constant(3, 0.5f);
  const double F = 0.04;
  const double passed = (1 - F) * (1 - F) * 0.5 / (1 - F * F * 0.25);
  EXPECT_NEAR(crossing_share(*pane.dielectric)[0], 0.8 * passed * (1 + F) / (1 - F), 3e-7);
}

TEST(Media, AbsorbByBeerAndLambertWhereLightIsWithin) {
  Scene scene;
  scene.materials = {glass(0.0f), glass(0.0f), mirror(0.0f)};
  scene.materials[0].dielectric->absorption = Spectrum::Constant(3, 2.0f);
  scene.materials[1].dielectric->absorption = Spectrum::Constant(3, 0.5f);
  const ScatteringSample inwards{.direction = -up, .weight = Spectrum::Ones(3), .crosses = true};
  ScatteringSample back = inwards;
  back.crosses = false;
  const auto passed = [&](const Media& media, int material, bool from_back) {
    return media.passed(scene, material, from_back, 0.3)[0];
  };
  Media media;
  EXPECT_EQ(passed(media, 2, false), 1.0f);
  // From inside: a surface that is hit from behind surrounds the origin.
  EXPECT_FLOAT_EQ(passed(media, 0, true), std::exp(-0.6f));
  media.cross(0, scene.materials[0], inwards, false);
  EXPECT_FLOAT_EQ(passed(media, 2, false), std::exp(-0.6f));  // a mirror within the glass
  media.cross(1, scene.materials[1], inwards, false);         // a bubble of the other medium
  EXPECT_FLOAT_EQ(passed(media, 1, true), std::exp(-0.15f));
  media.cross(1, scene.materials[1], back, true);  // reflected within
  EXPECT_FLOAT_EQ(passed(media, 2, false), std::exp(-0.15f));
  media.cross(1, scene.materials[1], inwards, true);
  EXPECT_FLOAT_EQ(passed(media, 2, false), std::exp(-0.6f));
  media.cross(0, scene.materials[0], inwards, true);
  EXPECT_EQ(passed(media, 2, false), 1.0f);
}

TEST(Media, BodiesWithinBodiesBeyondAllMeasureAreForgottenNotWrittenBeyond) {
  Scene scene;
  scene.materials = {glass(0.0f)};
  scene.materials[0].dielectric->absorption = Spectrum::Constant(3, 1.0f);
  const ScatteringSample inwards{.direction = -up, .weight = Spectrum::Ones(3), .crosses = true};
  Media media;
  for (int i = 0; i < 100; ++i) media.cross(0, scene.materials[0], inwards, false);
  EXPECT_FLOAT_EQ(media.passed(scene, 0, false, 1.0)[0], std::exp(-1.0f));
  for (int i = 0; i < 200; ++i) media.cross(0, scene.materials[0], inwards, true);
  EXPECT_EQ(media.passed(scene, 0, false, 1.0)[0], 1.0f);
}

}  // namespace
}  // namespace lightwell::specular_test
