#include "scene/io/glossy.h"

#include <gtest/gtest.h>

#include <cmath>

#include "scene/coat.h"
#include "scene/optics.h"
#include "tests/pictures.h"

namespace lightwell::glossy_test {
namespace {

Spectrum grey(float value) {
  return Spectrum::Constant(3, value);
}

// Radiance is n^2 larger inside; otherwise the transmittances in both directions are equal by
// reciprocity: (1 - F_i) n^2 = 1 - F_o (Saunderson 1942). The midpoint rule over 1000 steps misses
// the square-root edge of total reflection by less than a step, 1e-3.
TEST(Glossy, WhatPassesInwardsAndOutwardsDiffersByTheSquareOfTheIndex) {
  for (const double n : {1.1, 1.33, 1.5, 2.4}) {
    const double outside = diffuse_fresnel(n), inside = diffuse_fresnel(1.0 / n);
    EXPECT_NEAR((1.0 - inside) * n * n, 1.0 - outside, 1e-3 * n * n) << n;
  }
}

// Walsh's closed form for n = 1.5 is 0.0918 (Walsh 1926; Duntley 1942).
TEST(Glossy, GlassReflectsNinePercentOfDiffuseLight) {
  EXPECT_NEAR(diffuse_fresnel(1.5), 0.0918, 5e-5);
}

// With a base of reflectance b: b (1 - s F_o) where light does not go to and fro below a coat that
// mirrors the share s of F_o.
TEST(Glossy, CoatsAreLaidOverBasesAndTheirPictures) {
  Material lacquer{.reflectance = grey(0.5f), .specular = grey(0.0f), .emission = grey(0.0f)};
  lay_simple_coat(lacquer, 1.5, 0.2, grey(0.5f));
  EXPECT_NEAR(lacquer.reflectance[0], 0.5 * (1.0 - 0.5 * CoatedBase(lacquer).mean_mirrored()),
              1e-6);
  EXPECT_FLOAT_EQ(lacquer.specular[1], 0.5f);
  EXPECT_FLOAT_EQ(lacquer.specular_roughness, 0.2f);
  ASSERT_TRUE(lacquer.coat);
  EXPECT_FLOAT_EQ(lacquer.coat->index_of_refraction, 1.5f);

  Material glaze{.reflectance = grey(0.5f), .specular = grey(0.0f), .emission = grey(0.0f)};
  glaze.texture = ReflectanceTexture{.image = picture_of(1, 1, {0.5f}), .factor = grey(1.0f)};
  lay_coat(glaze, 1.5, 0.0, grey(1.0f));
  // Texels have 16 bits, of the square root: steps of 2e-5 here.
  EXPECT_NEAR(glaze.texture->image.picture->mean()[0], glaze.reflectance[0], 4e-5);
}

TEST(Glossy, ExponentsOfPhongBecomeWidths) {
  EXPECT_DOUBLE_EQ(alpha_of_exponent(0.0), 1.0);
  EXPECT_DOUBLE_EQ(alpha_of_exponent(198.0), 0.1);
}

TEST(Glossy, SmoothMetalsAreMirrorsAndRoughOnesDiffuse) {
  Material material;
  set_metallic(material, grey(0.8f), 0.25, 0.0);
  EXPECT_FLOAT_EQ(material.specular[0], 0.2f);
  EXPECT_FLOAT_EQ(material.reflectance[0], 0.6f);
  set_metallic(material, grey(0.8f), 0.25, 1.0);
  EXPECT_FLOAT_EQ(material.specular[0], 0.0f);
  EXPECT_FLOAT_EQ(material.reflectance[0], 0.8f);
}

}  // namespace
}  // namespace lightwell::glossy_test
