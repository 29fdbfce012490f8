// Light between surfaces whose shares vary by place.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "mesh/build_patches.h"
#include "mesh/patches/patch_patterns.h"
#include "radiosity/gather/final_gather.h"
#include "radiosity/paths/light_path.h"
#include "radiosity/solve.h"
#include "scene/coat.h"
#include "scene/material_at.h"
#include "scene/specular.h"
#include "tests/pictures.h"
#include "tests/radiosity/test_scenes.h"

namespace lightwell::patterns_test {
namespace {

// Half a step of the square-root code at a share of a half: sqrt(1/2) / 65535.
constexpr double half_step = 0.70711 / 65535;  // 1.1e-5

std::vector<float> squares(int across, float dark, float bright) {
  std::vector<float> texels;
  for (int i = 0; i < across * across; ++i) {
    texels.push_back((i % across + i / across) % 2 == 0 ? dark : bright);
  }
  return texels;
}

ShareTexture checker(int across, float dark, float bright) {
  return {.image = picture_of(across, across, squares(across, dark, bright))};
}

// A diffuse paint of reflectance rho under a coat, worn down to metal of the share that a picture
// gives.
Material worn(const Bands& bands, float base, float metal_color, const ShareTexture& metal) {
  Material material = test::diffuse(bands, 0.0f);
  material.specular = constant_spectrum(bands, 1.0f);
  material.coat = Coat{};
  SurfacePattern pattern = pattern_of(material);
  pattern.base = pattern.behind_base = constant_spectrum(bands, base);
  pattern.metal_color = constant_spectrum(bands, metal_color);
  pattern.metal = metal;
  set_pattern(material, pattern);
  return material;
}

// A closed room with a lamp below the ceiling; its floor has the material.
Scene room(const Material& floor) {
  Scene scene;
  const int white = test::add_material(scene, test::diffuse(scene.bands, 0.6f));
  const int below = test::add_material(scene, floor);
  Material shining = test::diffuse(scene.bands, 0.0f, 20.0f);
  shining.one_sided = false;
  const int lamp = test::add_material(scene, shining);
  test::add_box(scene, {0, 0, 0}, {2, 2, 2}, {white, white, white, white, below, white}, true);
  test::add_polygon(scene, "lamp", lamp,
                    {{0.8, 0.8, 1.9}, {0.8, 1.2, 1.9}, {1.2, 1.2, 1.9}, {1.2, 0.8, 1.9}});
  return scene;
}

SolveOptions quick() {
  SolveOptions options;
  options.mesh.max_patch_size = 0.25;
  options.form_factors.rays_per_patch = 512;
  options.gather.rays = 256;
  options.error_points = 64;
  return options;
}

// A checkerboard finer than the patches gives the same light as a floor that is everywhere the mean
// of both kinds of squares. Shares of patches are means over the same points, and rays are the
// same. Texels of 0 and 1 are exact and those of a half are off by half a step, which changes what
// the floor returns by no more than 0.9 of it. No surface returns more than 3/4, so the room
// multiplies a change by 1 / (1 - 3/4) at most.
TEST(Patterns, FineOnesLightARoomAsTheirMean) {
  const Bands bands = rgb_bands();
  Scene pictured = room(worn(bands, 0.5f, 0.9f, checker(64, 0.0f, 1.0f)));
  Scene even = room(worn(bands, 0.5f, 0.9f, checker(1, 0.5f, 0.5f)));
  lay_uv(pictured.surfaces[4]);
  lay_uv(even.surfaces[4]);
  const SolvedScene a = solve_scene(pictured, quick()), b = solve_scene(even, quick());
  ASSERT_EQ(a.mesh.patch_count(), b.mesh.patch_count());
  constexpr double of_texels = 4.0 * 0.9 * half_step;  // 3.9e-5
  const auto compare = [](const BandArray& x, const BandArray& y) {
    return ((x - y).abs() / y.abs().maxCoeff()).maxCoeff();
  };
  EXPECT_LT(compare(a.solution.patch_radiosity, b.solution.patch_radiosity), of_texels);
  EXPECT_LT(compare(a.solution.indirect_irradiance, b.solution.indirect_irradiance), of_texels);
  const auto& energy = a.solution.energy;
  // Every patch's float light is rounded by up to 2^-24 of all.
  const double rounding = std::min(1e-4, a.mesh.patch_count() * 0x1p-24);
  EXPECT_NEAR((energy.absorbed + energy.unshot) / energy.emitted, 1.0, rounding);
}

// Shares that each patch reflects and that paths which meet it carry on are all the light of a
// white surface.
TEST(Patterns, RowsAndPathsOfAPatchAddUpToAllLight) {
  for (const bool is_rough_in_places : {false, true}) {
    Material white = worn(rgb_bands(), 1.0f, 1.0f, checker(3, 0.1f, 0.8f));
    if (is_rough_in_places) {
      SurfacePattern pattern = *white.pattern;
      pattern.roughness = checker(5, 0.05f, 0.6f);  // finer than patches
      set_pattern(white, pattern);
    }
    Scene scene = room(white);
    lay_uv(scene.surfaces[4]);
    const PatchMesh mesh = build_patches(scene, {.max_patch_size = 0.25});
    ASSERT_TRUE(mesh.patterns);
    // Means of 256 points of floats have a standard error of sqrt(256) roundings.
    constexpr float rounding = 3 * 16 * 0x1p-24f;  // three standard errors, 2.9e-6
    int count = 0;
    for (int p = 0; p < mesh.patch_count(); ++p) {
      if (mesh.surface[p] != 4) continue;
      ++count;
      const Material mirror = mesh.patterns->mirror_of(scene.materials[1], p);
      EXPECT_NEAR(mesh.reflectance(p, 0) + mean_specular(mirror)[0], 1.0f, rounding);
    }
    EXPECT_GE(count, 64);  // 2 m x 2 m of patches no larger than 0.25 m
  }
}

// A world of B = 2 in which the floor, a white pattern of metal, coat and roughness, neither
// absorbs nor emits. Every surface then gets E = 2. Closed forms give the diffuse share of the
// floor and rays its mirrored share, whose sum is that which the closed forms say. Patches then
// have the residual of the solver, 1e-5, twice at most, since the walls return a half. Vertices
// have the noise of their rays, and interpolate the diffuse shares of patches, 0.4 apart, while
// mirrored shares are those of each patch: a vertex at the edge of the floor may see the half of
// one patch, whose diffuse share is then off by a quarter of 0.4. The mean over all vertices has no
// such error, and that of the rays of the 92 patches of walls and ceiling: 1.1e-2 / sqrt(92)
// = 1.2e-3, of which less than two are allowed.
TEST(Patterns, AWhiteFloorIsInvisibleInAFurnace) {
  Material white = worn(rgb_bands(), 1.0f, 1.0f, checker(5, 0.2f, 0.6f));
  SurfacePattern pattern = *white.pattern;
  pattern.coat = checker(3, 0.0f, 1.0f);
  pattern.roughness = checker(2, 0.05f, 0.4f);
  set_pattern(white, pattern);
  Scene scene = test::furnace(0.5f, 1.0f, false);
  scene.surfaces[4].material = test::add_material(scene, white);
  lay_uv(scene.surfaces[4]);
  SolveOptions options = quick();
  const SolvedScene solved = solve_scene(scene, options);
  double on_patches = 0.0;
  for (int p = 0; p < solved.mesh.patch_count(); ++p) {
    const double B = static_cast<double>(solved.solution.patch_radiosity(p, 0));
    const double wanted = solved.mesh.surface[p] == 4
                              ? 2.0 * static_cast<double>(solved.mesh.reflectance(p, 0))
                              : 2.0;
    on_patches = std::max(on_patches, std::abs(B - wanted) / 2.0);
  }
  const BandArray E = solved.solution.irradiance();
  const double at_vertices = (E.cast<double>() / 2.0 - 1.0).abs().maxCoeff();
  std::printf("white pattern in a furnace: patches %.1e, vertices %.1e\n", on_patches, at_vertices);
  EXPECT_LT(on_patches, 2e-5);
  EXPECT_LT(at_vertices, 1e-1);
  EXPECT_NEAR(E.cast<double>().mean() / 2.0, 1.0, 2e-3);
  EXPECT_NEAR(solved.solution.energy.absorbed / solved.solution.energy.emitted, 1.0, 1e-3);
}

// A white sheet is part of an evenly lit white room, however much of it is there: what it does not
// reflect passes from behind. So E is 1 close to a sheet whose opacity varies from patch to patch,
// too. Rays pass by chance; the tolerance is four standard errors of 4096 rays, each 0 or 1 at an
// opacity of 0.1 or 0.9.
TEST(Patterns, ASheetPassesNearByWhatItDoesNotReflect) {
  Scene scene;
  Material material = test::diffuse(scene.bands, 1.0f);
  const int white = test::add_material(scene, material);
  test::add_box(scene, {0, 0, 0}, {2, 2, 2}, {white, white, white, white, white, white}, true);
  material.one_sided = false;
  SurfacePattern pattern = pattern_of(material);
  pattern.opacity = ShareTexture{.image = picture_of(4, 1, {0.1f, 0.9f, 0.1f, 0.9f})};
  set_pattern(material, pattern);
  test::add_polygon(scene, "sheet", test::add_material(scene, material),
                    {{0.5, 0.5, 1}, {1.5, 0.5, 1}, {1.5, 1.5, 1}, {0.5, 1.5, 1}});
  lay_uv(scene.surfaces.back());
  const PatchMesh mesh = build_patches(scene, {.max_patch_size = 0.25});
  const ElementCaster caster(mesh);
  const DirectLight light(scene, mesh);
  const BandArray ones = BandArray::Ones(mesh.vertex_count(), scene.bands.count());
  std::vector<GatherPoint> points;
  for (const double x : {0.73, 0.77, 0.98, 1.02}) {
    points.push_back({.position = {x, 1.1, 1.01}, .normal = {0, 0, -1}});
  }
  const BandArray E =
      gather_irradiance({scene, caster, light}, gatherable_radiosity(mesh, light, ones), points,
                        {.rays = 4096})
          .indirect;
  const double deviation = std::sqrt(0.1 * 0.9);
  EXPECT_LT((E - 1.0f).abs().maxCoeff(), 4.0 * deviation / std::sqrt(4096.0));
}

// A sheet whose picture of opacity is an even grey lets the sun's or a lamp's light straight
// through as one of that regular transmittance does.
TEST(Patterns, OpacityLetsLightThrough) {
  const auto floor_light = [](const Material& sheet) {
    Scene scene = room(test::diffuse(rgb_bands(), 0.3f));
    const int m = test::add_material(scene, sheet);
    test::add_polygon(scene, "sheet", m,
                      {{0.2, 0.2, 1.0}, {1.8, 0.2, 1.0}, {1.8, 1.8, 1.0}, {0.2, 1.8, 1.0}});
    lay_uv(scene.surfaces.back());
    const SolvedScene solved = solve_scene(scene, quick());
    double power = 0.0;
    for (int p = 0; p < solved.mesh.patch_count(); ++p) {
      if (solved.mesh.surface[p] == 4) {
        power += solved.mesh.area[p] * static_cast<double>(solved.solution.patch_radiosity(p, 0));
      }
    }
    return power;
  };
  Material plain = test::diffuse(rgb_bands(), 0.5f);
  plain.one_sided = false;
  Material pictured = plain;
  SurfacePattern pattern = pattern_of(pictured);
  pattern.opacity = checker(32, 0.3f, 0.5f);
  set_pattern(pictured, pattern);
  plain.reflectance = constant_spectrum(rgb_bands(), 0.2f);
  plain.regular_transmittance = constant_spectrum(rgb_bands(), 0.6f);
  // Rays are the same, and those that pass find 0.5 or 0.7 in squares of 5 cm: 64 shadow rays to
  // each of some thousand vertices, and as many paths, leave 0.1 / sqrt(64e3) = 4e-4 of 0.6. Four
  // such standard errors are allowed.
  const double noise = 4.0 * 0.1 / std::sqrt(64e3) / 0.6;  // 2.6e-3
  const double even = floor_light(plain);
  EXPECT_NEAR(floor_light(pictured), even, noise * even);
}

}  // namespace
}  // namespace lightwell::patterns_test
