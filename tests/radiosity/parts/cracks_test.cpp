#include <gtest/gtest.h>

#include <algorithm>

#include "mesh/build_patches.h"
#include "mesh/elements/element_caster.h"
#include "part_scenes.h"
#include "radiosity/parts/find_parts.h"
#include "radiosity/solve.h"

namespace lightwell::cracks_test {
namespace {

using namespace test;

// A room of 4 m x 5 m x 3 m with a lamp, and a cupboard in the wall behind a door that leaves a
// slit: 0.6 m x 1 m x 2 m, in which rays have a quarter of their length in the room.
Scene room_and_cupboard(double slit) {
  Scene scene = rooms_with_doors(
      {{"room", {0, 0, 0}, {4, 5, 3}}, {"cupboard", {4.02, 1, 0}, {4.62, 2, 2}}},
      {{.x = 4.0, .thickness = 0.02, .y = 1.2, .width = slit, .height = 1.9}}, 0.5f);
  const int lamp = add_material(scene, diffuse(scene.bands, 0.0f, 100.0f));
  add_polygon(scene, "lamp", lamp,
              {{1.8, 2.3, 2.9}, {1.8, 2.7, 2.9}, {2.2, 2.7, 2.9}, {2.2, 2.3, 2.9}});
  return scene;
}

SceneParts parts_of(const Scene& scene) {
  const PatchMesh mesh = build_patches(scene, {.auto_patch_count = 600});
  const ElementCaster caster(mesh);
  return find_parts(scene, caster, LightPaths(scene, caster, 8));
}

// Names of the parts that are lit by cracks.
std::vector<std::string> lit_by_cracks(const SceneParts& parts) {
  std::vector<std::string> names;
  for (const ScenePart& part : parts.parts) {
    if (part.is_lit_by_cracks) names.push_back(part.name);
  }
  return names;
}

TEST(LitByCracks, ACupboardThatIsShut) {
  for (const double slit : {0.0005, 0.003}) {
    Scene scene = room_and_cupboard(slit);
    turn(scene, 0.4, {1, 2, 3});
    const SceneParts parts = parts_of(scene);
    ASSERT_EQ(parts.count(), 2) << slit;
    EXPECT_EQ(lit_by_cracks(parts), std::vector<std::string>{"cupboard"}) << slit;
  }
}

TEST(LitByCracks, NoCupboardThatIsAjar) {
  const SceneParts parts = parts_of(room_and_cupboard(0.08));
  ASSERT_EQ(parts.count(), 2);
  EXPECT_TRUE(lit_by_cracks(parts).empty());
}

TEST(LitByCracks, NoRoomHoweverNarrowItsDoor) {
  for (const double slit : {0.0005, 0.003}) {
    const SceneParts parts = parts_of(bright_and_dim(slit));
    ASSERT_EQ(parts.count(), 2);
    EXPECT_TRUE(lit_by_cracks(parts).empty()) << slit;
  }
}

TEST(LitByCracks, NoCupboardWithLightOfItsOwn) {
  Scene shining = room_and_cupboard(0.001), lamp = shining;
  const int glow = add_material(shining, diffuse(shining.bands, 0.0f, 1.0f));
  add_polygon(shining, "strip", glow,
              {{4.1, 1.2, 1.9}, {4.1, 1.8, 1.9}, {4.2, 1.8, 1.9}, {4.2, 1.2, 1.9}});
  lamp.lamps.push_back({.position = {4.3, 1.5, 1.0}, .intensity = Spectrum::Ones(3)});
  for (const Scene& scene : {shining, lamp}) {
    EXPECT_TRUE(lit_by_cracks(parts_of(scene)).empty());
  }
}

// Two cavities, such as the halves of a hollow wall, share much of the light of one crack.
TEST(LitByCracks, CavitiesBehindACavity) {
  Scene scene =
      rooms_with_doors({{"room", {0, 0, 0}, {4, 5, 3}},
                        {"first", {4.02, 1, 0}, {4.32, 3, 2}},
                        {"second", {4.34, 1, 0}, {4.64, 3, 2}}},
                       {{.x = 4.0, .thickness = 0.02, .y = 1.2, .width = 0.001, .height = 1.9},
                        {.x = 4.32, .thickness = 0.02, .y = 1.8, .width = 0.2, .height = 1.0}},
                       0.5f);
  const int lamp = add_material(scene, diffuse(scene.bands, 0.0f, 100.0f));
  add_polygon(scene, "lamp", lamp,
              {{1.8, 2.3, 2.9}, {1.8, 2.7, 2.9}, {2.2, 2.7, 2.9}, {2.2, 2.3, 2.9}});
  const SceneParts parts = parts_of(scene);
  ASSERT_EQ(parts.count(), 3);
  std::vector<std::string> names = lit_by_cracks(parts);
  std::ranges::sort(names);
  EXPECT_EQ(names, (std::vector<std::string>{"first", "second"}));
}

// The outside of a house whose wall has a seam, at night, under a sky, and with a lamp.
TEST(LitByCracks, TheOutsideAtNight) {
  Scene night = room_and_cupboard(0.001);
  std::erase_if(night.surfaces, [](const Surface& s) { return s.name == "cupboard"; });
  for (Material& material : night.materials) material.one_sided = false;
  Scene day = night, street = night;
  day.sky = dark_sky(day.bands);
  day.sky->scale = Spectrum::Ones(3);
  street.lamps.push_back({.position = {9.0, 2.0, 4.0}, .intensity = Spectrum::Ones(3)});
  EXPECT_EQ(lit_by_cracks(parts_of(night)).size(), 1u);
  EXPECT_TRUE(lit_by_cracks(parts_of(day)).empty());
  EXPECT_TRUE(lit_by_cracks(parts_of(street)).empty());
}

TEST(LitByCracks, IsNotJudgedButSaid) {
  const Scene scene = room_and_cupboard(0.001);
  const SolvedScene solved = solve_scene(scene, {.accuracy = Accuracy{.share = 0.1}});
  const SceneParts& parts = solved.solution.parts;
  ASSERT_EQ(parts.count(), 2);
  EXPECT_EQ(solved.solution.outcome, Outcome::converged);
  EXPECT_EQ(solved.solution.error_estimate, parts.parts[0].error_estimate);
  EXPECT_EQ(parts.parts[1].error_estimate, -1.0) << "not estimated";
  float worst = 0.0f;
  for (int e = 0; e < solved.mesh.element_count(); ++e) {
    const int part = parts.of_patch[solved.mesh.patch[e]];
    if (part == 1) worst = std::max(worst, solved.solution.interpolation_error[e]);
  }
  EXPECT_GT(worst, 0.0f) << "bounds of places are measured in any case";
}

TEST(LitByCracks, IsJudgedWhereSomebodyLooks) {
  SceneParts parts{.of_patch = {0, 1, 1},
                   .parts = {{.name = "room"}, {.name = "cupboard", .is_lit_by_cracks = true}}};
  EXPECT_TRUE(parts.is_judged(0));
  EXPECT_FALSE(parts.is_judged(1));
  parts.importance = {0.5f, 1.0f, 0.5f};
  EXPECT_TRUE(parts.is_judged(0));
  EXPECT_TRUE(parts.is_judged(1));
  EXPECT_FALSE(parts.is_judged(2));
}

}  // namespace
}  // namespace lightwell::cracks_test
