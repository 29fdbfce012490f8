// Pictures of surfaces whose roughness, metal and coat vary by place.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <numbers>

#include "raytrace/shading/shade.h"
#include "scene/coat.h"
#include "scene/material_at.h"
#include "tests/pictures.h"
#include "tests/raytrace/lit_scene.h"

namespace lightwell::pattern_picture_test {
namespace {

constexpr auto pi_f = std::numbers::pi_v<float>;
const Eigen::Vector3d up = Eigen::Vector3d::UnitZ();

ShareTexture share(int across, const std::vector<float>& texels) {
  return {.image = picture_of(across, static_cast<int>(texels.size()) / across, texels)};
}

Spectrum grey(float value) {
  return Spectrum::Constant(3, value);
}

// A lacquer of index 1.5 over a base.
Material lacquer(float base, float alpha) {
  Material material{.reflectance = grey(0.0f),
                    .specular = grey(1.0f),
                    .specular_roughness = alpha,
                    .coat = Coat{},
                    .emission = grey(0.0f)};
  material.reflectance = base * (1.0f - mean_mirrored(material));
  return material;
}

void put_material(Scene& scene, std::size_t surface, const Material& material) {
  scene.surfaces[surface].material = static_cast<int>(scene.materials.size());
  scene.materials.push_back(material);
  lay_uv(scene.surfaces[surface]);
}

double radiance(const TracedScene& lit, const Ray& ray, std::uint64_t key = 1) {
  return static_cast<double>(RayTree(lit.scene, lit.caster, lit.direct_light, lit.solution, {})
                                 .trace(ray, key)
                                 .radiance[0]);
}

// In a world of radiance 1 a white surface with pictures of roughness, metal and coat is invisible
// at every angle. The lobe mirrors Fresnel's share at each sampled microfacet of the part that is
// coated, with a standard deviation of up to 0.06 between rays at 80 degrees and 0.03 elsewhere:
// 6400 rays leave 0.06 / 80 = 7.5e-4 and 4e-4, and the tables of the base are 2e-4 from the lobes.
// One such error suffices, as the rays are spread evenly.
TEST(PatternInAFurnace, WhiteIsInvisible) {
  Material white = lacquer(1.0f, 0.0f);
  SurfacePattern pattern = pattern_of(white);
  pattern.base = pattern.behind_base = pattern.metal_color = grey(1.0f);
  pattern.metal = share(2, {0.0f, 0.2f, 1.0f, 0.6f});
  pattern.coat = share(3, {1.0f, 0.5f, 0.0f});
  pattern.roughness = share(2, {0.0f, 0.3f, 0.1f, 0.5f});
  set_pattern(white, pattern);
  Scene scene = SceneBuilder()
                    .box({.exitance = pi_f}, {-3, -3, -3}, {3, 3, 3}, true)
                    .square({}, {0, 0, 0}, up, 1.0)
                    .build();
  put_material(scene, 1, white);
  TracedScene lit(scene);
  lit.set_indirect([](const Eigen::Vector3d&) { return pi_f; });
  const RenderOptions options;
  const RayTree tree(lit.scene, lit.caster, lit.direct_light, lit.solution, options);
  for (const double degrees : {0.0, 30.0, 60.0, 80.0}) {
    const double angle = degrees * std::numbers::pi / 180.0;
    double sum = 0.0;
    constexpr int across = 80;
    for (int i = 0; i < across * across; ++i) {
      const Eigen::Vector3d at(1.9 * (i % across + 0.5) / across - 0.95,
                               1.9 * (i / across + 0.5) / across - 0.95, 0.0);
      const Eigen::Vector3d from(2.0 * std::sin(angle), 0.1, 2.0 * std::cos(angle));
      sum += static_cast<double>(tree.trace({.origin = at + from, .direction = -from.normalized()},
                                            static_cast<std::uint64_t>(i))
                                     .radiance[0]);
    }
    const double mean = sum / (across * across);
    std::printf("white pattern in a furnace at %g degrees: %.5f\n", degrees, mean);
    EXPECT_NEAR(mean, 1.0, 1e-3) << degrees;
  }
}

// Each square of a checkerboard of two lacquers shows what a surface of that lacquer alone shows:
// the same rays, whose numbers differ by the rounding of texels. The roughness is that of steps of
// the tables, so that nothing is interpolated. Their square-root codes are 16383.75 and 32767.5
// before rounding: either is off by 3.1e-5 of itself. The lobe's density and its masking lie
// between the powers -4 and 4 of the roughness.
TEST(Patterns, SquaresShowTheMaterialOfTheirNumbers) {
  constexpr float fine = 0.0625f, coarse = 0.25f;
  constexpr double of_texels = 4.0 * 3.1e-5;
  Material board = lacquer(0.5f, fine);
  SurfacePattern pattern = pattern_of(board);
  pattern.base = pattern.behind_base = grey(0.5f);
  pattern.roughness = share(2, {fine, coarse});
  set_pattern(board, pattern);
  const auto scene_of = [](const Material& material) {
    Scene scene = SceneBuilder()
                      .square({}, {0, 0, 0}, up, 1.0)
                      .square({.exitance = 30.0f}, {0.3, 0.2, 2.0}, -up, 0.2)
                      .square({.exitance = 1.0f}, {-2.0, 0.0, 1.0}, Eigen::Vector3d::UnitX(), 1.0)
                      .build();
    put_material(scene, 0, material);
    return scene;
  };
  const TracedScene pictured(scene_of(board), 0.5);
  const TracedScene shiny(scene_of(lacquer(0.5f, fine)), 0.5);
  const TracedScene dull(scene_of(lacquer(0.5f, coarse)), 0.5);
  for (int i = 0; i < 40; ++i) {
    const double y = -0.9 + 1.8 * i / 39.0;
    for (const bool is_left : {true, false}) {
      // u runs along the square's first edge; which half is which follows from the map.
      const Eigen::Vector3d at(is_left ? -0.5 : 0.5, y, 0.0);
      const auto& mesh = std::get<PolygonMesh>(pictured.scene.surfaces[0].shape);
      const bool is_fine = mesh.uv_maps[0].at(at).x() < 0.5;
      const Eigen::Vector3d from = Eigen::Vector3d(0.4, -0.7, 1.5);
      const Ray ray{.origin = at + from, .direction = -from.normalized()};
      const auto key = static_cast<std::uint64_t>(i);
      const double alone = radiance(is_fine ? shiny : dull, ray, key);
      EXPECT_NEAR(radiance(pictured, ray, key), alone, of_texels * alone) << i << is_left;
    }
  }
}

// A pixel that covers many squares of half metal and half paint shows the mean of both.
TEST(Patterns, AreFilteredOverThePixel) {
  Material material{.reflectance = grey(0.6f), .specular = grey(0.0f), .emission = grey(0.0f)};
  SurfacePattern pattern = pattern_of(material);
  std::vector<float> texels;
  for (int i = 0; i < 64 * 64; ++i) texels.push_back((i % 64 + i / 64) % 2 == 0 ? 1.0f : 0.0f);
  pattern.metal = share(64, texels);
  pattern.metal_color = grey(0.9f);
  set_pattern(material, pattern);
  Scene scene = SceneBuilder()
                    .square({}, {0, 0, 0}, up, 1.0)
                    .square({.exitance = pi_f}, {0, 0, 8.0}, -up, 4.0)
                    .build();
  put_material(scene, 0, material);
  TracedScene lit(scene, 0.5);
  lit.set_indirect([](const Eigen::Vector3d&) { return pi_f; });
  const Ray ray{.origin = {0.013, 0.017, 4.0}, .direction = -up};
  const RenderOptions options;
  const RayTree tree(lit.scene, lit.caster, lit.direct_light, lit.solution, options);
  const auto far = tree.trace(ray, 1, 1.0f, {.start = 0.5, .spread = 0.0});
  const auto paint = static_cast<double>(tree.trace(ray, 1, 1.0f, {}).radiance[0]);
  const Ray beside{.origin = ray.origin + Eigen::Vector3d(2.0 / 64, 0, 0), .direction = -up};
  const auto metal = static_cast<double>(tree.trace(beside, 1, 1.0f, {}).radiance[0]);
  // Each of six coarser levels of 64 texels is a mean to half a step of the square-root code,
  // sqrt(1/2) / 65535, of what metal and paint differ by, less than 1.
  constexpr double of_levels = 6 * 0.70711 / 65535;  // 6.5e-5
  EXPECT_NEAR(static_cast<double>(far.radiance[0]), 0.5 * (paint + metal), of_levels);
  EXPECT_GT(std::abs(paint - metal), 0.1) << "of a difference of 0.3 in reflectance";
}

}  // namespace
}  // namespace lightwell::pattern_picture_test
