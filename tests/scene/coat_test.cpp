#include "scene/coat.h"

#include <gtest/gtest.h>

#include <cmath>

#include "scene/errors.h"
#include "scene/optics.h"
#include "scene/scene.h"
#include "scene/specular.h"

namespace lightwell::coat_test {
namespace {

Spectrum grey(float value) {
  return Spectrum::Constant(3, value);
}

Material coated(float index, float roughness, float reflectance = 0.0f) {
  Material material{.name = "lacquer",
                    .reflectance = grey(reflectance),
                    .specular = grey(1.0f),
                    .specular_roughness = roughness,
                    .emission = grey(0.0f)};
  material.coat = Coat{.index_of_refraction = index};
  return material;
}

// 2 int g cos dcos by the midpoint rule in cos^2, 1000 steps. A smooth coat's mean is made by the
// same rule, so only rounding is left. A rough coat's table has 64 steps between which A is taken
// as linear: the error is below step^2 / 8 of the largest second derivative, 64 at grazing
// incidence where it fills one step of 64, 2 (1/64)^3 64 / 8 = 6e-5; the midpoint rule's is as
// large.
TEST(CoatedBase, FactorsAverageToOne) {
  for (const float index : {1.2f, 1.5f, 2.4f}) {
    for (const float roughness : {0.0f, 0.1f, 0.5f}) {
      const CoatedBase base(coated(index, roughness));
      double mean = 0.0;
      for (int i = 0; i < 1000; ++i) mean += base.factor(std::sqrt((i + 0.5) / 1000.0)) / 1000.0;
      EXPECT_NEAR(mean, 1.0, roughness > 0.0f ? 2e-4 : 1e-12) << index << " " << roughness;
    }
  }
}

// A white base under a coat: what the base gives and what the coat mirrors are all of the light, at
// every angle. Spectra are floats.
TEST(CoatedBase, AWhiteBaseAndItsCoatReflectAllLightAtEveryAngle) {
  const Material material = coated(1.5f, 0.0f);
  const CoatedBase base(material);
  const double rho = static_cast<double>(CoatOverBase(material).reflectance(grey(1.0f))[0]);
  for (const double cosine : {1.0, 0.8, 0.5, 0.2, 0.05}) {
    const SmoothScattering mirrored =
        smooth_scattering({.material = material,
                           .direction = {std::sqrt(1.0 - cosine * cosine), 0.0, -cosine},
                           .normal = Eigen::Vector3d::UnitZ()});
    ASSERT_EQ(mirrored.count, 1);
    const auto F = static_cast<double>(mirrored.sample[0].weight[1]);
    EXPECT_NEAR(F, fresnel_reflectance(cosine, 1.5), 1e-7);
    EXPECT_NEAR(rho * base.factor(cosine) + F, 1.0, 1e-6) << cosine;
  }
}

// Directions in which microfacets of alpha 0.1 tilt by some 6 degrees average over Fresnel's curve,
// whose second derivative by the angle is below 1 up to 60 degrees: 0.1^2 / 2 at most.
TEST(CoatedBase, ASlightlyRoughCoatMirrorsAsASmoothOneFarFromGrazing) {
  const CoatedBase smooth(coated(1.5f, 0.0f)), rough(coated(1.5f, 0.1f));
  // Ratios, since the means differ: light that grazes the surface meets microfacets more steeply.
  for (const double cosine : {0.9, 0.7, 0.5}) {
    EXPECT_NEAR(rough.factor(cosine) / rough.factor(1.0),
                smooth.factor(cosine) / smooth.factor(1.0), 5e-3)
        << cosine;
  }
  EXPECT_LT(rough.mean_mirrored(), smooth.mean_mirrored());
}

// F_o = 0.0918 (Walsh 1926); (1 - F_i) = (1 - F_o) / 2.25; rho of a base of one half by Saunderson.
TEST(CoatOverBase, FollowsSaunderson) {
  const Material material = coated(1.5f, 0.0f);
  const double F_o = 0.0918, F_i = 1.0 - (1.0 - F_o) / 2.25;
  const double rho = (1.0 - F_o) * (1.0 - F_i) * 0.5 / (1.0 - 0.5 * F_i);
  EXPECT_NEAR(CoatOverBase(material).reflectance(grey(0.5f))[0], rho, 5e-5);
  EXPECT_NEAR(mean_mirrored(material)[2], F_o, 5e-5);
  // Without saturation the light below a white base's coat comes back.
  EXPECT_NEAR(CoatOverBase(material, false).reflectance(grey(0.5f))[0], 0.5 * (1.0 - F_o), 5e-5);
}

TEST(CoatedBases, AreThoseOfCoatedMaterials) {
  const std::vector<Material> materials = {coated(1.5f, 0.0f), Material{}};
  const CoatedBases bases(materials);
  EXPECT_FALSE(bases.empty());
  EXPECT_NE(bases.of(0), nullptr);
  EXPECT_EQ(bases.of(1), nullptr);
  EXPECT_TRUE(CoatedBases({Material{}}).empty());
  EXPECT_THROW(CoatedBase(Material{}), std::invalid_argument);
}

Scene square_of(const Material& material) {
  PolygonMesh mesh{.vertices = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}}, .facets = {Facet{{0, 1, 2}}}};
  return {.materials = {material}, .surfaces = {{.name = "square", .shape = mesh}}};
}

TEST(Validate, RefusesCoatsThatMakeLight) {
  EXPECT_NO_THROW(validate(square_of(coated(1.5f, 0.0f, 0.908f))));
  EXPECT_THROW(validate(square_of(coated(1.5f, 0.0f, 0.92f))), InputError);
  EXPECT_THROW(validate(square_of(coated(0.9f, 0.0f))), InputError);
  EXPECT_THROW(validate(square_of(coated(1.5f, 2.0f))), InputError);
  Material both = coated(1.5f, 0.0f);
  both.specular = grey(0.0f);
  both.dielectric = Dielectric{.tint = grey(1.0f)};
  EXPECT_THROW(validate(square_of(both)), InputError);
}

TEST(SceneHash, KnowsCoats) {
  const std::uint64_t of_one = scene_hash(square_of(coated(1.5f, 0.0f)));
  EXPECT_NE(of_one, scene_hash(square_of(coated(1.6f, 0.0f))));
  Material bare = coated(1.5f, 0.0f);
  bare.coat.reset();
  EXPECT_NE(of_one, scene_hash(square_of(bare)));
}

}  // namespace
}  // namespace lightwell::coat_test
