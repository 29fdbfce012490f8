#include "scene/material_at.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "scene/coat.h"
#include "scene/errors.h"
#include "scene/facet_textures.h"
#include "scene/sampling.h"
#include "scene/specular.h"
#include "tests/pictures.h"

namespace lightwell::material_at_test {
namespace {

// Sums and products of a few floats up to 1.
constexpr float rounding = 8 * std::numeric_limits<float>::epsilon();  // 9.5e-7

Spectrum grey(float value) {
  return Spectrum::Constant(3, value);
}

ShareTexture share(const std::vector<float>& texels, float factor = 1.0f) {
  return {.image = picture_of(static_cast<int>(texels.size()), 1, texels), .factor = factor};
}

Material paint(float rho, float index = 0.0f, float alpha = 0.0f) {
  Material material{.reflectance = grey(rho), .specular = grey(0.0f), .emission = grey(0.0f)};
  if (index > 0.0f) {
    material.specular = grey(1.0f);
    material.specular_roughness = alpha;
    material.coat = Coat{.index_of_refraction = index};
  }
  return material;
}

// All light of a white surface that passes half of what it scatters, under a white coat, with white
// metal and holes, goes on wherever its pictures stand.
TEST(MaterialAt, AWhiteSurfaceSendsOnAllLightEverywhere) {
  Material material = paint(0.0f, 1.5f);
  SurfacePattern pattern = pattern_of(material);
  pattern.base = grey(1.0f);
  pattern.behind_base = pattern.passed = grey(0.5f);
  pattern.metal_color = grey(1.0f);
  pattern.metal = pattern.coat = pattern.opacity = pattern.translucency = share({0.0f, 1.0f});
  pattern.roughness = share({0.0f, 1.0f});
  set_pattern(material, pattern);
  EXPECT_LT((mean_sent_on(material) - 1.0f).abs().maxCoeff(), rounding);
  for (std::uint64_t i = 0; i < 50; ++i) {
    const auto u = [&](std::uint64_t k) {
      return static_cast<float>(random_uniform(random_key(i, k)));
    };
    const Material here = material_at(
        material,
        {.roughness = u(0), .metal = u(1), .coat = u(2), .opacity = u(3), .translucency = u(4)});
    EXPECT_LT((mean_sent_on(here) - 1.0f).abs().maxCoeff(), rounding) << i;
    // At every angle: base and translucency by the factor of the coat, and what the coat mirrors.
    // F of a smooth coat is exact; the table of a rough one stands in for its lobe.
    const CoatedBase base(here);
    for (const double cosine : {1.0, 0.7, 0.3}) {
      const SurfaceInteraction interaction{
          .material = here,
          .direction = {std::sqrt(1.0 - cosine * cosine), 0.0, -cosine},
          .normal = Eigen::Vector3d::UnitZ()};
      const float under = here.reflectance[0] + here.transmittance[0];
      float all = under * static_cast<float>(base.factor(cosine)) +
                  straight_sample(interaction).weight[0] + here.coat->bare[0];
      constexpr int count = 4096;
      for (int s = 0; s < count; ++s) {
        const auto key = static_cast<std::uint64_t>(s);
        const ScatteringSample sample =
            sample_lobe(interaction, {.component = random_uniform(random_key(key, 1)),
                                      .u = random_uniform(random_key(key, 2)),
                                      .v = random_uniform(random_key(key, 3)),
                                      .key = key});
        all += (sample.weight[0] - here.coat->bare[0]) / count;
      }
      // F varies by 0.2 within a lobe: 0.2 / sqrt(4096) = 0.0031, of which three are allowed. The
      // table, a mean of 1024 stratified samples, errs by less than the rest, 0.0006.
      EXPECT_NEAR(all, 1.0f, 0.01f) << i << ' ' << cosine;
    }
  }
}

// The material is what it was wherever pictures of metal are black and others white, and a mirror
// alone wherever metal is white.
TEST(MaterialAt, EndsAreThePaintAndTheMetal) {
  const Material before = paint(0.4f, 1.5f, 0.2f);
  Material material = before;
  SurfacePattern pattern = pattern_of(material);
  pattern.metal = share({0.0f, 1.0f});
  pattern.metal_color = grey(0.8f);
  set_pattern(material, pattern);
  const Material painted = material_at(material, values_at(material, {0.2, 0.5}));
  EXPECT_NEAR(painted.reflectance[0], 0.4f, rounding);
  EXPECT_FLOAT_EQ(painted.specular[0], 1.0f);
  EXPECT_NEAR(CoatedBase(painted).factor(0.3), CoatedBase(before).factor(0.3), double{rounding});
  const Material metal = material_at(material, values_at(material, {0.7, 0.5}));
  EXPECT_EQ(metal.reflectance[0], 0.0f);
  EXPECT_EQ(metal.specular[0], 0.0f);
  EXPECT_FLOAT_EQ(metal.coat->bare[0], 0.8f);
  // The material itself is the mean of both halves, each a product of few floats.
  EXPECT_NEAR(material.reflectance[0], 0.2f, rounding);
  EXPECT_NEAR(material.coat->bare[0], 0.4f, rounding);
  EXPECT_NEAR(mean_mirrored(material)[0], 0.5f * (mean_mirrored(before)[0] + 0.8f), rounding);
}

// A colour of the texture tints base and metal alike, as in glTF.
TEST(MaterialAt, MetalShowsTheTexture) {
  Material material = paint(0.9f);
  material.texture = ReflectanceTexture{.image = picture_of(1, 1, {0.5f}), .factor = grey(0.9f)};
  SurfacePattern pattern = pattern_of(material);
  pattern.metal = share({1.0f}, 0.25f);
  pattern.metal_color = grey(0.9f);
  pattern.metal_shows_texture = true;
  set_pattern(material, pattern);
  // The square-root code is off by half a step, sqrt(1/2) / 65535, at a half; a texel of 1 is
  // exact.
  constexpr float of_texel = 0.7072f / 65535;  // 1.1e-5
  EXPECT_NEAR(material.reflectance[0], 0.9f * 0.5f * 0.75f, 0.9f * 0.75f * of_texel + rounding);
  EXPECT_NEAR(material.specular[0], 0.9f * 0.5f * 0.25f, 0.9f * 0.25f * of_texel + rounding);
  EXPECT_NEAR(material.texture->factor[0], 0.9f * 0.75f, rounding);
}

// Error of a value that is linear between the levels' steps, 1/16 of sqrt(alpha): an eighth of the
// largest second difference of neighbouring steps, twice because the curvature between steps may be
// larger than at them.
template <class Value>
double error_between_steps(const CoatLevels& levels, const Value& value) {
  constexpr int steps = 16;
  const auto at = [&](int i) { return value(levels.at(static_cast<float>(i * i) / 256.0f)); };
  double largest = 0.0;
  for (int i = 1; i < steps; ++i) {
    largest = std::max(largest, std::abs(at(i - 1) - 2.0 * at(i) + at(i + 1)));
  }
  return 2.0 * largest / 8.0;
}

TEST(CoatLevels, AreCloseToTablesOfTheirOwn) {
  const CoatLevels levels(paint(0.0f, 1.5f), 0.0f, 1.0f);
  const auto mean = [](const CoatedBase& base) { return base.mean_mirrored(); };
  const double of_mean = error_between_steps(levels, mean);
  EXPECT_LT(of_mean, 0.002);
  for (const double cosine : {0.1, 0.3, 0.6, 1.0}) {
    const auto factor = [&](const CoatedBase& base) { return base.factor(cosine); };
    const double of_factor = error_between_steps(levels, factor);
    EXPECT_LT(of_factor, 0.01);
    for (const float alpha : {0.0f, 0.03f, 0.1f, 0.22f, 0.6f}) {
      const CoatedBase exact(paint(0.0f, 1.5f, alpha)), level = levels.at(alpha);
      EXPECT_NEAR(level.mean_mirrored(), exact.mean_mirrored(), of_mean) << alpha;
      EXPECT_NEAR(level.factor(cosine), exact.factor(cosine), of_factor) << alpha << ' ' << cosine;
    }
  }
}

// The lobe's density is 1 over the hemisphere at any roughness: the table's mean over 256 points,
// and between its steps the curvature, is within 0.01.
TEST(RoughLobe, OfVaryingRoughnessIntegratesToOne) {
  Material material = paint(0.0f);
  material.specular = grey(1.0f);
  SurfacePattern pattern = pattern_of(material);
  pattern.roughness = share({0.0f, 1.0f});
  set_pattern(material, pattern);
  const RoughLobe lobe(material, false);
  for (const float alpha : {0.1f, 0.3f, 0.7f}) {
    const Material here = material_at(material, {.roughness = alpha});
    const SurfaceInteraction interaction{.material = here,
                                         .direction = Eigen::Vector3d(0.6, 0.0, -0.8),
                                         .normal = Eigen::Vector3d::UnitZ()};
    constexpr int rows = 400, columns = 800;
    double sum = 0.0;
    for (int i = 0; i < rows; ++i) {
      const double z = (i + 0.5) / rows, r = std::sqrt(1.0 - z * z);
      for (int j = 0; j < columns; ++j) {
        const double phi = 2.0 * std::numbers::pi * (j + 0.5) / columns;
        sum += lobe.density(interaction, {r * std::cos(phi), r * std::sin(phi), z});
      }
    }
    EXPECT_NEAR(sum * 2.0 * std::numbers::pi / (rows * columns), 1.0, 0.01) << alpha;
  }
}

Scene square_of(Material material) {
  Scene scene;
  scene.materials = {std::move(material)};
  PolygonMesh mesh{.vertices = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}};
  mesh.facets = {Facet{.boundary = {0, 1, 2, 3}}};
  scene.surfaces = {{.name = "square", .shape = mesh}};
  lay_uv(scene.surfaces[0]);
  return scene;
}

TEST(Validate, ChecksPatterns) {
  Material material = paint(0.4f);
  SurfacePattern pattern = pattern_of(material);
  pattern.metal = share({0.0f, 1.0f});
  pattern.metal_color = grey(0.8f);
  set_pattern(material, pattern);
  EXPECT_NO_THROW(validate(square_of(material)));
  EXPECT_NE(scene_hash(square_of(material)), scene_hash(square_of(paint(0.4f))));
  pattern.metal_color = grey(1.1f);
  set_pattern(material, pattern);
  EXPECT_THROW(validate(square_of(material)), InputError);
  pattern.metal_color = Spectrum();
  EXPECT_THROW(
      {
        Material broken = paint(0.4f);
        broken.pattern = std::make_shared<const SurfacePattern>(pattern);
        validate(square_of(broken));
      },
      InputError);
}

}  // namespace
}  // namespace lightwell::material_at_test
