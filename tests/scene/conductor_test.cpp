// Metals by angle: Fresnel's equations of a complex index.
#include "scene/conductor.h"

#include <gtest/gtest.h>

#include <cmath>

#include "scene/coat.h"
#include "scene/errors.h"
#include "scene/optics.h"
#include "scene/sampling.h"
#include "scene/scene.h"
#include "scene/specular.h"

namespace lightwell::conductor_test {
namespace {

Spectrum grey(float value) {
  return Spectrum::Constant(3, value);
}

Conductor tungsten() {
  return {.eta = Spectrum{{2.8656f, 2.11918f, 1.94008f}},
          .k = Spectrum{{3.03233f, 2.05611f, 1.61629f}}};
}

Material metal(float roughness) {
  Material material{.name = "metal",
                    .reflectance = grey(0.0f),
                    .specular = grey(1.0f),
                    .specular_roughness = roughness,
                    .emission = grey(0.0f)};
  material.metal = tungsten();
  return material;
}

// A metal without absorption reflects as glass; with a huge one it reflects everything.
TEST(Metals, ReflectByTheirComplexIndex) {
  EXPECT_NEAR(mean_reflectance({grey(1.5f), grey(0.0f)})[0], diffuse_fresnel(1.5), 1e-7);
  EXPECT_NEAR(mean_reflectance({grey(1.5f), grey(1e6f)})[0], 1.0, 1e-6);
}

// Tungsten in red, green and blue: Fresnel's equations in real numbers (Born & Wolf, 14.2), by a
// Gauss rule of 64 points in the cosine, from which the midpoint rule differs by 1e-5.
TEST(Metals, ReflectTheMeanOverTheHemisphere) {
  const Spectrum eta{{2.8656f, 2.11918f, 1.94008f}}, k{{3.03233f, 2.05611f, 1.61629f}};
  const Spectrum mean = mean_reflectance({eta, k});
  const Spectrum expected{{0.521393f, 0.412530f, 0.344282f}};
  EXPECT_LT((mean - expected).abs().maxCoeff(), 3e-5f);
}

// ((eta - 1)^2 + k^2) / ((eta + 1)^2 + k^2) along the normal, 1 at the horizon, and Fresnel's
// equations of glass without k.
TEST(Metals, ReflectAsKnownAtBothEndsAndAsGlassWithoutAbsorption) {
  const Conductor tungsten = conductor_test::tungsten();
  const Spectrum normal = ((tungsten.eta - 1.0f).square() + tungsten.k.square()) /
                          ((tungsten.eta + 1.0f).square() + tungsten.k.square());
  EXPECT_LT((reflectance_at(tungsten, 1.0) - normal).abs().maxCoeff(), 1e-6f);
  EXPECT_LT((reflectance_at(tungsten, 0.0) - 1.0f).abs().maxCoeff(), 1e-6f);
  for (const double cosine : {0.1, 0.5, 0.9}) {
    EXPECT_NEAR(reflectance_at({grey(1.5f), grey(0.0f)}, cosine)[0],
                fresnel_reflectance(cosine, 1.5), 1e-6);
  }
}

// A smooth metal has one direction; a rough one scatters the same share both ways between two
// directions.
TEST(Metals, MirrorBothWaysAlike) {
  const Material smooth = metal(0.0f), rough = metal(0.3f);
  const Eigen::Vector3d up = Eigen::Vector3d::UnitZ();
  for (const double angle : {0.1, 0.7, 1.3}) {
    const Eigen::Vector3d in(std::sin(angle), 0.0, -std::cos(angle));
    const SmoothScattering mirrored = smooth_scattering({smooth, in, up});
    ASSERT_EQ(mirrored.count, 1);
    EXPECT_LT(
        (mirrored.sample[0].weight - reflectance_at(tungsten(), std::cos(angle))).abs().maxCoeff(),
        1e-6f);
    const Eigen::Vector3d out = Eigen::Vector3d(0.3, 0.4, 0.5).normalized();
    const Spectrum there = scattering_weight({rough, in, up}, {.direction = out});
    const Spectrum back = scattering_weight({rough, -out, up}, {.direction = -in});
    EXPECT_LT((there - back).abs().maxCoeff(), 1e-6f);
  }
}

// The share that a rough metal mirrors of even light: directions by the cosine, a sample of the
// lobe each. A weight lies between the least and 1, so the mean of 65536 independent ones is known
// to 0.25 / 256 = 0.001; stratified ones to less. Microfacets lean towards grazing light: at
// cosines below 2 alpha = 0.2, which 4 % of even light has, tungsten's reflectance rises by up to
// 0.3, and a part of that is lost.
TEST(Metals, MirrorTheirMeanOfEvenLight) {
  constexpr int count = 1 << 16;
  const SobolPoints points(count);
  for (const float roughness : {0.0f, 0.1f}) {
    const Material material = metal(roughness);
    Spectrum sum = grey(0.0f);
    for (int i = 0; i < count; ++i) {
      const Eigen::Array4d u = points.point(i, 1).cast<double>();
      const double cosine = std::sqrt(u[3]), sine = std::sqrt(1.0 - u[3]);
      const ScatteringSample sample = sample_lobe(
          {material, {sine, 0.0, -cosine}, Eigen::Vector3d::UnitZ()},
          {.component = u[2], .u = u[0], .v = u[1], .key = static_cast<std::uint64_t>(i)});
      sum += sample.weight;
    }
    EXPECT_LT((sum / count - mean_mirrored(material)).abs().maxCoeff(), 0.001f + 0.12f * roughness)
        << roughness;
  }
}

TEST(Metals, OfNonsenseAreRefusedAndHashed) {
  Scene scene;
  scene.materials.push_back(metal(0.0f));
  EXPECT_NO_THROW(validate(scene));
  const std::uint64_t before = scene_hash(scene);
  scene.materials[0].metal->k[1] = 2.5f;
  EXPECT_NE(scene_hash(scene), before);
  scene.materials[0].metal->k[1] = -1.0f;
  EXPECT_THROW(validate(scene), InputError);
  scene.materials[0] = metal(0.0f);
  scene.materials[0].coat = Coat{};
  EXPECT_THROW(validate(scene), InputError);
}

}  // namespace
}  // namespace lightwell::conductor_test
