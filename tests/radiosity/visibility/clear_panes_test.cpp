#include "radiosity/visibility/clear_panes.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

#include "mesh/build_patches.h"
#include "radiosity/direct_light/direct_light.h"
#include "radiosity/gather/caustic_irradiance.h"
#include "radiosity/gather/final_gather.h"
#include "radiosity/paths/caustic_photons.h"
#include "scene/optics.h"
#include "tests/radiosity/test_scenes.h"

namespace lightwell::clear_panes_test {
namespace {

using Eigen::Vector3d;

constexpr float index_of_glass = 1.5f;
constexpr double half_lamp = 1e-3;

Material pane(const Bands& bands, float roughness = 0.0f) {
  Material material = test::clear_glass(bands);
  material.dielectric->thin = true;
  material.dielectric->roughness = roughness;
  material.dielectric->tint << 0.9f, 0.5f, 1.0f;
  return material;
}

void add_square(Scene& scene, const Material& material, double z, double half, bool down = false) {
  const double x = down ? -half : half;
  test::add_polygon(scene, "square " + std::to_string(scene.surfaces.size()),
                    test::add_material(scene, material),
                    {{-x, -half, z}, {x, -half, z}, {x, half, z}, {-x, half, z}});
}

// A lamp of 2 mm side, 2 m above a floor.
Scene lamp_over_floor() {
  Scene scene;
  add_square(scene, test::diffuse(scene.bands, 0.5f), 0.0, 4.0);
  add_square(scene, test::diffuse(scene.bands, 0.0f, 1e6f), 2.0, half_lamp, true);
  return scene;
}

struct Lit {
  Scene scene;
  PatchMesh mesh = build_patches(scene, {.max_patch_size = 1.0});
  ElementCaster caster{mesh};
  DirectLight light{scene, mesh};

  Spectrum at(double x, EmitterVisibility* visibility = nullptr) const {
    return light.irradiance(caster, {.at = {{x, 0.0, 0.0}, Vector3d::UnitZ(), 0}, .key = 1},
                            visibility);
  }
};

// Transmittance of `count` panes, straight through, at the angle at which the floor at x sees the
// lamp: that of one pane for each polarisation to the power `count`.
double passed(double x, int count) {
  const double cosine = 2.0 / std::hypot(2.0, x);
  const PolarisedReflectance face = polarised_reflectance(cosine, double{index_of_glass});
  double sum = 0.0;
  for (const double r : {face.s, face.p}) sum += 0.5 * std::pow((1.0 - r) / (1.0 + r), count);
  return sum;
}

class BehindPanes : public testing::TestWithParam<int> {};

TEST_P(BehindPanes, LightOfALampIsWhatTheyPass) {
  const Lit bare{lamp_over_floor()};
  Scene scene = lamp_over_floor();
  for (int i = 0; i < GetParam(); ++i) add_square(scene, pane(scene.bands), 0.5 + 0.3 * i, 4.0);
  const Lit lit{scene};
  for (const double x : {0.0, 1.0, 3.0}) {
    const Spectrum without = bare.at(x);
    EmitterVisibility visibility;
    const Spectrum with = lit.at(x, &visibility);
    for (int k = 0; k < 3; ++k) {
      const double tint = double{pane(scene.bands).dielectric->tint[k]};
      const double expected =
          double{without[k]} * passed(x, GetParam()) * std::pow(tint, GetParam());
      // The lamp is a millimetre wide, over which the angle differs by 5e-4; single precision.
      EXPECT_NEAR(double{with[k]}, expected, 1e-3 * expected);
    }
    EXPECT_EQ(visibility.whole, 1u);
    EXPECT_EQ(visibility.hidden, 0u);
    EXPECT_EQ(visibility.noisy, 0.0);
  }
}

INSTANTIATE_TEST_SUITE_P(Panes, BehindPanes, testing::Values(1, 2, 5));

TEST(ClearPanes, WithABodyDimInclinedLightMore) {
  const Lit bare{lamp_over_floor()};
  Scene scene = lamp_over_floor();
  Material window = pane(scene.bands);
  window.dielectric->tint.setOnes();
  window.dielectric->transmissivity = Eigen::Array3f(0.25f, 0.7f, 1.0f);
  add_square(scene, window, 0.5, 4.0);
  const Lit lit{scene};
  for (const double x : {0.0, 1.0, 3.0}) {
    const Spectrum without = bare.at(x), with = lit.at(x);
    for (int k = 0; k < 3; ++k) {
      const double t = double{window.dielectric->transmissivity[k]};
      const double expected =
          double{without[k]} *
          pane_shares(2.0 / std::hypot(2.0, x), double{index_of_glass}, t).passed;
      // The lamp is a millimetre wide, over which the angle differs by 5e-4; single precision.
      EXPECT_NEAR(double{with[k]}, expected, 1e-3 * expected);
    }
  }
}

TEST(ClearPanes, WhatIsBehindOrBeforeThemStillHidesALamp) {
  for (const double z : {0.2, 1.5}) {
    Scene scene = lamp_over_floor();
    add_square(scene, pane(scene.bands), 1.0, 4.0);
    add_square(scene, test::diffuse(scene.bands, 0.5f), z, 0.5);
    const Lit lit{scene};
    EmitterVisibility visibility;
    EXPECT_EQ(lit.at(0.0, &visibility).maxCoeff(), 0.0f);
    EXPECT_EQ(visibility.hidden, 1u);
    EXPECT_GT(lit.at(3.0).minCoeff(), 0.0f);
  }
}

TEST(ClearPanes, RoughPanesAndBodiesOfGlassAreNone) {
  Scene scene = lamp_over_floor();
  add_square(scene, pane(scene.bands, 0.1f), 1.0, 4.0);
  EXPECT_TRUE(ClearPanes(scene).empty());
  EXPECT_EQ(Lit{scene}.at(0.0).maxCoeff(), 0.0f);
  Scene thick = lamp_over_floor();
  add_square(thick, test::clear_glass(thick.bands), 1.0, 4.0);
  EXPECT_TRUE(ClearPanes(thick).empty());
}

// Light straight through a pane is direct light and must not be counted as a caustic again. Below
// the pane, photons and rays of the solver bring none of the lamp's light; above the pane, the
// reflected light.
TEST(ClearPanes, WhatTheyPassIsNoCaustic) {
  Scene scene = lamp_over_floor();
  add_square(scene, pane(scene.bands), 1.0, 4.0);
  add_square(scene, test::diffuse(scene.bands, 0.5f), 3.0, 4.0, true);  // ceiling
  const Lit lit{scene};
  const auto photons = shoot_photons({scene, lit.caster, lit.light}, 1 << 14, 8);
  ASSERT_GT(photons.count(), 0u);
  double reflected = 0.0;
  for (std::size_t i = 0; i < photons.count(); ++i) {
    EXPECT_NEAR(photons.position[i].z(), 3.0, 1e-5);
    reflected += double{photons.power(static_cast<Eigen::Index>(i), 0)};
  }
  EXPECT_GT(reflected, 0.0);
  const BandArray E = caustic_irradiance({scene, lit.caster, lit.light}, 1 << 14, 8);
  for (int v = 0; v < lit.mesh.vertex_count(); ++v) {
    if (lit.mesh.position(v).z() < 0.5) {
      EXPECT_EQ(E.row(v).maxCoeff(), 0.0f);
    }
  }
}

}  // namespace
}  // namespace lightwell::clear_panes_test
