#include "scene/io/glossy.h"

#include <gtest/gtest.h>

#include <cmath>

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

TEST(Glossy, AWhiteBaseUnderAClearCoatGivesBackAllLight) {
  const Spectrum all = coated_reflectance(grey(1.0f), 1.5, true, grey(1.0f));
  EXPECT_LT((all - 1.0f).abs().maxCoeff(), 1e-6f);  // float arithmetic
}

TEST(Glossy, ABlackBaseLeavesTheCoatsReflection) {
  const Spectrum coat = coated_reflectance(grey(0.0f), 1.5, true, grey(1.0f));
  EXPECT_NEAR(coat[0], diffuse_fresnel(1.5), 1e-6);
  EXPECT_EQ(coated_reflectance(grey(0.0f), 1.5, true, grey(0.0f))[0], 0.0f);
}

// A metal without absorption reflects as glass; with a huge one it reflects everything.
TEST(Glossy, MetalsReflectByTheirComplexIndex) {
  EXPECT_NEAR(diffuse_metal_reflectance(grey(1.5f), grey(0.0f))[0], diffuse_fresnel(1.5), 1e-7);
  EXPECT_NEAR(diffuse_metal_reflectance(grey(1.5f), grey(1e6f))[0], 1.0, 1e-6);
}

// Tungsten in red, green and blue: Fresnel's equations in real numbers (Born & Wolf, 14.2), by a
// Gauss rule of 64 points in the cosine, from which the midpoint rule differs by 1e-5.
TEST(Glossy, MetalsReflectTheMeanOverTheHemisphere) {
  const Spectrum eta{{2.8656f, 2.11918f, 1.94008f}}, k{{3.03233f, 2.05611f, 1.61629f}};
  const Spectrum mean = diffuse_metal_reflectance(eta, k);
  const Spectrum expected{{0.521393f, 0.412530f, 0.344282f}};
  EXPECT_LT((mean - expected).abs().maxCoeff(), 3e-5f);
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
