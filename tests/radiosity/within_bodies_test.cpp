// Light of what lies within solid glass, under water, and in bubbles.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "radiosity/paths/squared_indices.h"
#include "radiosity/solve.h"
#include "radiosity/visibility/absorbing_bodies.h"
#include "tests/radiosity/test_scenes.h"
#include "tests/sample_mean.h"

namespace lightwell::within_bodies_test {
namespace {

constexpr float glass = 1.5f;

Material body(const Bands& bands, float index) {
  Material material = test::diffuse(bands, 0.0f);
  material.dielectric =
      Dielectric{.index_of_refraction = index, .tint = constant_spectrum(bands, 1.0f)};
  return material;
}

// A sheet in height z, of half reflectance and shining on both sides, or white.
void add_sheet(Scene& scene, const std::string& name, float exitance, double z) {
  Material material = test::diffuse(scene.bands, exitance > 0.0f ? 0.5f : 1.0f, exitance);
  material.one_sided = false;
  material.emits_both_sides = exitance > 0.0f;
  const int m = test::add_material(scene, material);
  test::add_polygon(scene, name, m,
                    {{0.45, 0.55, z}, {0.55, 0.55, z}, {0.55, 0.65, z}, {0.45, 0.65, z}});
}

// Every surface of the room reflects a half and emits n^2 / 2, where n is the index of what is
// around the surface, or is white, so that L / n^2 is 1 / pi everywhere and B = n^2. A ball of
// glass holds a sheet, and a bubble in the ball another one. No light is trapped in the ball, which
// happens farther than its radius over n from its middle.
Scene furnace_with_a_ball(bool sheets_shine) {
  Scene scene = test::furnace(0.5f, 0.5f, false);
  const int ball = test::add_material(scene, body(scene.bands, glass));
  const int bubble = test::add_material(scene, body(scene.bands, 1.0f / glass));
  scene.surfaces.push_back(
      {.name = "ball", .material = ball, .shape = Sphere{{0.5, 0.6, 0.45}, 0.3}});
  scene.surfaces.push_back(
      {.name = "bubble", .material = bubble, .shape = Sphere{{0.5, 0.6, 0.5}, 0.15}});
  const float M = sheets_shine ? 0.5f : 0.0f;
  add_sheet(scene, "in the bubble", M, 0.52);
  add_sheet(scene, "in the glass", M * glass * glass, 0.3);
  return scene;
}

double index_around(const std::string& surface) {
  return surface == "in the glass" ? double{glass} : 1.0;
}

TEST(SquaredIndices, AreThoseOfTheBodiesAroundAPatch) {
  const Scene scene = furnace_with_a_ball(true);
  const PatchMesh mesh = build_patches(scene, {.max_patch_size = 0.2});
  const Eigen::ArrayXd found = squared_indices(scene, ElementCaster(mesh));
  ASSERT_EQ(found.size(), mesh.patch_count());
  for (int p = 0; p < mesh.patch_count(); ++p) {
    const std::string& name = scene.surfaces[static_cast<std::size_t>(mesh.surface[p])].name;
    if (name == "ball" || name == "bubble") continue;
    // The index of the bubble is a float's rounding, 2^-24, off 1 / 1.5, and is squared.
    EXPECT_NEAR(found[p], std::pow(index_around(name), 2), std::ldexp(3.0, -24)) << name;
  }
}

TEST(SquaredIndices, AreNoneWhereNothingLiesInABody) {
  Scene scene = test::furnace(0.5f, 0.5f, true);
  const PatchMesh empty = build_patches(scene, {.max_patch_size = 0.3});
  EXPECT_EQ(squared_indices(scene, ElementCaster(empty)).size(), 0);
  const int ball = test::add_material(scene, body(scene.bands, glass));
  scene.surfaces.push_back(
      {.name = "ball", .material = ball, .shape = Sphere{{0.8, 0.9, 0.5}, 0.1}});
  const PatchMesh mesh = build_patches(scene, {.max_patch_size = 0.3});
  EXPECT_EQ(squared_indices(scene, ElementCaster(mesh)).size(), 0);
}

// The ball absorbs; of the sheets, the one in the bubble is not in its glass.
TEST(AbsorbingBodies, AreThoseAroundPatchesAndPoints) {
  Scene scene = furnace_with_a_ball(true);
  scene.materials[1].dielectric->absorption = constant_spectrum(scene.bands, 0.5f);
  const PatchMesh mesh = build_patches(scene, {.max_patch_size = 0.2});
  const ElementCaster caster(mesh);
  const auto bodies = AbsorbingBodies::find(scene, caster);
  ASSERT_NE(bodies, nullptr);
  for (int p = 0; p < mesh.patch_count(); ++p) {
    const std::string& name = scene.surfaces[static_cast<std::size_t>(mesh.surface[p])].name;
    // The front of the bubble lies in the glass of the ball.
    const bool is_within = name == "in the glass" || (name == "bubble" && mesh.is_back[p] == 0);
    EXPECT_EQ(bodies->before_patch(p) != nullptr, is_within) << name;
  }
  const auto absorbs = [&](double x, double y, double z) {
    return bodies->around(caster, {.position = {x, y, z}}) != nullptr;
  };
  EXPECT_TRUE(absorbs(0.5, 0.6, 0.25));
  EXPECT_FALSE(absorbs(0.5, 0.6, 0.45)) << "in the bubble";
  EXPECT_FALSE(absorbs(0.9, 1.1, 0.8)) << "outside";
}

TEST(AbsorbingBodies, AreNoneWithoutPatchesWithin) {
  Scene scene = furnace_with_a_ball(true);
  scene.materials[1].dielectric->absorption = constant_spectrum(scene.bands, 0.5f);
  std::erase_if(scene.surfaces, [](const Surface& surface) {
    return surface.name.starts_with("in the") || surface.name == "bubble";
  });
  EXPECT_EQ(AbsorbingBodies::find(scene, ElementCaster(build_patches(scene, {}))), nullptr);
}

class SolvedFurnace {
 public:
  SolvedFurnace(bool sheets_shine, bool shoots) : scene_(furnace_with_a_ball(sheets_shine)) {
    SolveOptions options;
    options.mesh.max_patch_size = 0.06;
    options.form_factors.rays_per_patch = 1024;
    options.gather.rays = 1024;
    // Unshot light of a thousandth is far below the noise of the rows, some percent.
    if (shoots) options.progressive = ProgressiveOptions{.tolerance = 1e-3};
    solved_ = solve_scene(scene_, options);
  }

  const RadiositySolution& solution() const { return solved_.solution; }
  // Relative errors of the radiosities of diffuse patches, within the glass or elsewhere.
  std::vector<double> patch_errors(bool in_glass) const {
    std::vector<double> errors;
    for (int p = 0; p < solved_.mesh.patch_count(); ++p) {
      if (counts(p, in_glass)) errors.push_back(error(p, solution().patch_radiosity(p, 0)));
    }
    return errors;
  }
  // Relative errors of the irradiance gathered at vertices, within the glass or elsewhere.
  std::vector<double> vertex_errors(bool in_glass) const {
    const BandArray E = solution().irradiance();
    const std::vector<int> patch = vertex_patches(solved_.mesh);
    std::vector<double> errors;
    for (int v = 0; v < solved_.mesh.vertex_count(); ++v) {
      const int p = patch[static_cast<std::size_t>(v)];
      if (counts(p, in_glass)) errors.push_back(error(p, E(v, 0)));
    }
    return errors;
  }

 private:
  const std::string& name(int p) const {
    return scene_.surfaces[static_cast<std::size_t>(solved_.mesh.surface[p])].name;
  }
  bool counts(int p, bool in_glass) const {
    return solved_.mesh.reflectance(p, 0) > 0.0f && (name(p) == "in the glass") == in_glass;
  }
  double error(int p, float value) const {
    return double{value} / std::pow(index_around(name(p)), 2) - 1.0;
  }

  Scene scene_;
  SolvedScene solved_;
};

double worst(const std::vector<double>& errors) {
  double largest = 0.0;
  for (const double error : errors) largest = std::max(largest, std::abs(error));
  return largest;
}

// Some roundings of floats.
const double roundings = std::ldexp(8.0, -24);

// Rows close, so even light L / n^2 solves the equations whatever the noise of the rows.
TEST(FurnaceWithABall, HasTheBasicRadianceOfTheRoomWithinTheGlass) {
  const SolvedFurnace furnace(true, false);
  EXPECT_LT(worst(furnace.patch_errors(true)), roundings);
  EXPECT_LT(worst(furnace.patch_errors(false)), roundings);
  const EnergyBalance& e = furnace.solution().energy;
  EXPECT_NEAR((e.absorbed + e.escaped) / e.emitted, 1.0, roundings);
}

// White sheets send no light of their own by way of the ball, so rays alone find all light within
// the glass. Each ray reads 1 / n^2 times n^2, and a mean of floats is off by some roundings.
TEST(FurnaceWithABall, IsGatheredEvenlyWithinTheGlass) {
  const SolvedFurnace furnace(false, false);
  EXPECT_LT(worst(furnace.vertex_errors(true)), roundings);
  EXPECT_LT(worst(furnace.vertex_errors(false)), roundings);
}

// Shots cast few rays where little light is left, so single patches are some percent off, and their
// mean by four standard errors at most. These are small enough to tell: with the light of the room
// n^2 times too weak or too strong, B = 1/2 n^2 + 1/2 E would be off by more than a quarter.
TEST(FurnaceWithABall, IsTheSameByShooting) {
  const SolvedFurnace furnace(true, true);
  const auto [mean, standard_error] = test::mean_of(furnace.patch_errors(true));
  EXPECT_NEAR(mean, 0.0, 4.0 * standard_error);
  EXPECT_LT(4.0 * standard_error, 0.25);
}

}  // namespace
}  // namespace lightwell::within_bodies_test
