#include "radiosity/dark_rooms.h"

#include <gtest/gtest.h>

#include "radiosity/solve.h"
#include "tests/radiosity/test_scenes.h"

namespace lightwell::dark_rooms_test {
namespace {

using test::add_box;
using test::add_material;

constexpr std::array<int, 6> white = {0, 0, 0, 0, 0, 0};

Scene with_materials() {
  Scene scene;
  Material paint = test::diffuse(scene.bands, 0.5f);
  paint.one_sided = false;
  add_material(scene, paint);
  add_material(scene, test::diffuse(scene.bands, 0.0f, 100.0f));
  return scene;
}

void add_lamp(Scene& scene, double x) {
  test::add_polygon(scene, "lamp", 1,
                    {{x, 1.2, 2.6}, {x, 1.6, 2.6}, {x + 0.4, 1.6, 2.6}, {x + 0.4, 1.2, 2.6}});
}

DarkRooms found_in(const Scene& scene) {
  SolveOptions options;
  options.mesh.max_patch_size = 0.5;
  options.form_factors.rays_per_patch = 64;
  options.gather.rays = 32;
  options.refine.tolerance = 0.0;
  options.error_points = 0;
  const SolvedScene solved = solve_scene(scene, options);
  return find_dark_rooms(scene, solved.mesh, solved.solution);
}

// The underside of a block, the floor below it and the inside of the block get no light, and so do
// the outside of the walls and the space between two leaves of them.
TEST(DarkRooms, AreNotUnderFurnitureNorOutsideAHouse) {
  Scene scene = with_materials();
  add_box(scene, {0, 0, 0}, {4, 3, 2.7}, white, true);
  add_box(scene, {-0.3, -0.3, -0.3}, {4.3, 3.3, 3.0}, white, false);
  add_box(scene, {1, 1, 0}, {2, 2, 0.9}, white, false);
  test::add_polygon(scene, "ground", 0,
                    {{-9, -9, -0.3}, {13, -9, -0.3}, {13, 12, -0.3}, {-9, 12, -0.3}});
  add_lamp(scene, 2.5);
  const DarkRooms dark = found_in(scene);
  EXPECT_EQ(dark.area, 0.0);
  EXPECT_EQ(dark.surface, -1);
}

// In a scene that is no larger than a room, too, a metre inside of a block is no room.
TEST(DarkRooms, AreNotInsideABlock) {
  Scene scene = with_materials();
  add_box(scene, {0, 0, 0}, {4, 3, 2.7}, white, true);
  add_box(scene, {1, 1, 0}, {2, 2, 0.9}, white, false);
  add_lamp(scene, 2.5);
  EXPECT_EQ(found_in(scene).area, 0.0);
}

// The wall between both rooms is lit from one side.
TEST(DarkRooms, AreRoomsWithoutALamp) {
  Scene scene = with_materials();
  add_box(scene, {0, 0, 0}, {4, 3, 2.7}, white, true);
  add_box(scene, {4, 0, 0}, {9, 3, 2.7}, white, true);
  scene.surfaces.erase(scene.surfaces.begin() + 6);  // the second room's leaf of the common wall
  scene.surfaces[8].name = "the longest wall";
  add_lamp(scene, 2.5);
  const DarkRooms dark = found_in(scene);
  const double room = 2 * (5 * 3 + 5 * 2.7 + 3 * 2.7);
  // Across a corner of the room, its three elements of at most a quarter of a square metre may be
  // narrower than 0.6 m and not count.
  EXPECT_LE(dark.area, (1.0 + 1e-6) * room);
  EXPECT_GE(dark.area, room - 24 * 0.25);
  EXPECT_NEAR(dark.share, dark.area / (room - 3 * 2.7 + 2 * (4 * 3 + 4 * 2.7 + 3 * 2.7)), 1e-6);
  ASSERT_GE(dark.surface, 6);
  EXPECT_LT(dark.surface, 11);
}

}  // namespace
}  // namespace lightwell::dark_rooms_test
