#include "radiosity/parts/find_parts.h"

#include <gtest/gtest.h>

#include <map>
#include <set>

#include "mesh/build_patches.h"
#include "part_scenes.h"
#include "radiosity/parts/cut_graph.h"

namespace lightwell::find_parts_test {
namespace {

using namespace test;

struct Found {
  PatchMesh mesh{};
  SceneParts parts{};
};

Found found_in(const Scene& scene, int patches = 600) {
  Found found;
  found.mesh = build_patches(scene, {.auto_patch_count = patches});
  const ElementCaster caster(found.mesh);
  found.parts = find_parts(scene, caster, LightPaths(scene, caster, 8));
  return found;
}

// Expects all patches of a material that face as the first patch of the mesh to be in one part, and
// their backs not to be in that part.
void expect_sides_apart(const Found& found, int material) {
  for (int p = 0; p < found.mesh.patch_count(); ++p) {
    if (found.mesh.material[p] != material) continue;
    EXPECT_EQ(found.parts.of_patch[p] == found.parts.of_patch[0],
              found.mesh.is_back[p] == found.mesh.is_back[0]);
  }
}

int add_two_sided(Scene& scene) {
  Material material = diffuse(scene.bands, 0.5f);
  material.one_sided = false;
  return add_material(scene, material);
}

// The parts that patches of each surface name belong to.
std::map<std::string, std::set<int>> parts_by_name(const Scene& scene, const Found& found) {
  std::map<std::string, std::set<int>> by_name;
  for (int p = 0; p < found.mesh.patch_count(); ++p) {
    by_name[scene.surfaces[found.mesh.surface[p]].name].insert(found.parts.of_patch[p]);
  }
  return by_name;
}

TEST(FindParts, ADoorPartsTwoRooms) {
  for (const double width : {0.001, 0.01, 0.1, 0.5, 0.9}) {
    for (const double angle : {0.0, 0.7}) {
      SCOPED_TRACE(testing::Message() << width << " m, turned by " << angle);
      Scene scene = bright_and_dim(width);
      turn(scene, angle, {1, 2, 3});
      const Found found = found_in(scene);
      ASSERT_EQ(found.parts.count(), 2);
      const auto by_name = parts_by_name(scene, found);
      EXPECT_EQ(by_name.at("bright").size(), 1u);
      EXPECT_EQ(by_name.at("dim").size(), 1u);
      EXPECT_NE(by_name.at("bright"), by_name.at("dim"));
      EXPECT_EQ(by_name.at("lamp"), by_name.at("bright"));
      // Each room has 94 m2, its share of the reveal and the lamp besides, and the door missing.
      for (const ScenePart& part : found.parts.parts) EXPECT_NEAR(part.area, 94.0, 2.5);
    }
  }
}

TEST(FindParts, AWideOpeningDoesNot) {
  EXPECT_EQ(found_in(bright_and_dim(4.5)).parts.count(), 1);
}

TEST(FindParts, OneRoomIsOnePart) {
  Scene empty;
  const int m = add_material(empty, diffuse(empty.bands, 0.5f));
  const std::array<int, 6> all = {m, m, m, m, m, m};
  Scene hall = empty, furnished = empty, flat = empty, block = empty;
  add_box(empty, {0, 0, 0}, {4, 5, 3}, all, true);
  add_box(hall, {0, 0, 0}, {60, 10, 4}, all, true);
  add_box(flat, {0, 0, 0}, {40, 40, 2.5}, all, true);
  add_box(block, {0, 0, 0}, {1, 1, 1}, all, false);
  add_box(furnished, {0, 0, 0}, {4, 5, 3}, all, true);
  for (int i = 0; i < 4; ++i) {
    add_box(furnished, {0.5 + 0.8 * i, 1.0, 0.0}, {0.9 + 0.8 * i, 3.5, 0.9}, all, false);
  }
  add_box(furnished, {0.5, 4.0, 0.7}, {2.1, 4.8, 0.74}, all, false);
  for (const Scene& scene : {empty, hall, flat, block, furnished}) {
    for (const int patches : {60, 600, 3000}) {
      EXPECT_EQ(found_in(scene, patches).parts.count(), 1);
    }
  }
}

TEST(FindParts, WhatABlockWithoutBottomCoversIsNoPart) {
  Scene scene;
  const int m = add_material(scene, diffuse(scene.bands, 0.5f));
  add_box(scene, {0, 0, 0}, {4, 5, 3}, {m, m, m, m, m, m}, true);
  add_box(scene, {1, 1, 0}, {3, 3, 2}, {m, m, m, m, m, m}, false);
  std::erase_if(scene.surfaces,
                [&, n = 0](const Surface&) mutable { return ++n == 11; });  // bottom
  EXPECT_EQ(found_in(scene).parts.count(), 1);
}

TEST(FindParts, AnLShapedRoomIsOnePart) {
  Scene scene =
      rooms_with_doors({{"leg", {0, 0, 0}, {4, 9, 3}}, {"foot", {4.001, 0, 0}, {9, 4, 3}}},
                       {{.x = 4.0, .thickness = 0.001, .y = 0.0, .width = 4, .height = 3}});
  EXPECT_EQ(found_in(scene).parts.count(), 1);
}

// A corridor of 1.5 m x 12 m and three rooms on each side.
Scene house(double door_width) {
  std::vector<RoomBox> rooms{{"corridor", {4.1, 0, 0}, {5.6, 12.2, 2.6}}};
  std::vector<Doorway> doors;
  for (int i = 0; i < 3; ++i) {
    const double y = 4.1 * i;
    rooms.push_back({"west" + std::to_string(i), {0, y, 0}, {4, y + 4.0, 2.6}});
    rooms.push_back({"east" + std::to_string(i), {5.7, y, 0}, {9.7, y + 4.0, 2.6}});
    doors.push_back({.x = 4.0, .y = y + 1.0, .width = door_width});
  }
  for (int i = 0; i < 3; ++i) {
    doors.push_back({.x = 5.6, .y = 4.1 * i + 2.0, .width = door_width});
  }
  return rooms_with_doors(rooms, doors);
}

TEST(FindParts, EachRoomOfAHouseIsAPart) {
  for (const double width : {0.001, 0.05, 0.9}) {
    SCOPED_TRACE(width);
    Scene scene = house(width);
    turn(scene, 0.3, {3, 1, 2});
    const Found found = found_in(scene, 1500);
    EXPECT_EQ(found.parts.count(), 7);
    std::set<int> parts;
    for (const auto& [name, of] : parts_by_name(scene, found)) {
      if (name == "reveal") continue;
      EXPECT_EQ(of.size(), 1u) << name;
      parts.insert(of.begin(), of.end());
    }
    EXPECT_EQ(parts.size(), 7u);
    std::set<std::string> names;
    for (const ScenePart& part : found.parts.parts) names.insert(part.name);
    EXPECT_EQ(names.size(), 7u) << "every part has a name of its own";
  }
}

TEST(FindParts, TheGroundOutsideAWindowIsAPart) {
  Scene scene = rooms_with_doors(
      {{"office", {0, 0, 0}, {5, 6, 3}}},
      {{.x = 5.0, .thickness = 0.2, .y = 1.0, .width = 4.0, .z = 0.9, .height = 1.5}});
  const int ground = add_material(scene, diffuse(scene.bands, 0.2f));
  add_polygon(scene, "ground", ground, {{5.2, -60, 0}, {125, -60, 0}, {125, 60, 0}, {5.2, 60, 0}});
  const Found found = found_in(scene);
  ASSERT_EQ(found.parts.count(), 2);
  const auto by_name = parts_by_name(scene, found);
  EXPECT_EQ(by_name.at("ground").size(), 1u);
  EXPECT_EQ(by_name.at("office").size(), 1u);
  EXPECT_NE(by_name.at("ground"), by_name.at("office"));
}

// A window that takes up all of a wall has 14 % of the room's area.
TEST(FindParts, TheGroundOutsideAWallOfGlassIsAPart) {
  Scene scene = rooms_with_doors(
      {{"office", {0, 0, 0}, {5, 6, 3}}},
      {{.x = 5.0, .thickness = 0.2, .y = 0.1, .width = 5.8, .z = 0.1, .height = 2.8}});
  const int ground = add_material(scene, diffuse(scene.bands, 0.2f));
  add_polygon(scene, "ground", ground, {{5.2, -60, 0}, {125, -60, 0}, {125, 60, 0}, {5.2, 60, 0}});
  const Found found = found_in(scene);
  const auto by_name = parts_by_name(scene, found);
  EXPECT_EQ(by_name.at("ground").size(), 1u);
  EXPECT_EQ(by_name.at("office").size(), 1u);
  EXPECT_NE(by_name.at("ground"), by_name.at("office"));
}

// A box that is open on one side, as for a picture of it, and a block: most rays of the block's
// face leave through the opening.
TEST(FindParts, WhatStandsBeforeAnOpenSideIsNoOutside) {
  Scene scene;
  const int wall = add_material(scene, diffuse(scene.bands, 0.5f));
  add_polygon(scene, "floor", wall, {{0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {0, 4, 0}});
  add_polygon(scene, "ceiling", wall, {{0, 0, 4}, {0, 4, 4}, {4, 4, 4}, {4, 0, 4}});
  add_polygon(scene, "back", wall, {{0, 4, 0}, {4, 4, 0}, {4, 4, 4}, {0, 4, 4}});
  add_polygon(scene, "left", wall, {{0, 0, 0}, {0, 4, 0}, {0, 4, 4}, {0, 0, 4}});
  add_polygon(scene, "right", wall, {{4, 0, 0}, {4, 0, 4}, {4, 4, 4}, {4, 4, 0}});
  add_polygon(scene, "face", wall, {{1.5, 0.5, 1}, {2.5, 0.5, 1}, {2.5, 0.5, 2}, {1.5, 0.5, 2}});
  EXPECT_EQ(found_in(scene).parts.count(), 1);
}

// Half of the light of a passage under the open sky leaves it, and light there is much like that
// outside.
TEST(FindParts, APassageUnderTheOpenSkyIsNoPart) {
  Scene scene;
  const int wall = add_material(scene, diffuse(scene.bands, 0.5f));
  add_polygon(scene, "ground", wall, {{-60, -60, 0}, {60, -60, 0}, {60, 60, 0}, {-60, 60, 0}});
  add_polygon(scene, "left", wall, {{-2, -5, 0}, {-2, 5, 0}, {-2, 5, 3}, {-2, -5, 3}});
  add_polygon(scene, "right", wall, {{2, -5, 0}, {2, -5, 3}, {2, 5, 3}, {2, 5, 0}});
  EXPECT_EQ(found_in(scene).parts.count(), 1);
}

// The room has less than 1/1024 of the area of a dome of 60 m, and beside the dome it is a hollow.
TEST(FindParts, ADomeForTheSkyIsOutside) {
  for (const double radius : {40.0, 300.0, 2000.0}) {
    Scene scene = rooms_with_doors(
        {{"office", {0, 0, 0}, {5, 6, 3}}},
        {{.x = 5.0, .thickness = 0.2, .y = 1.0, .width = 1.0, .z = 0.9, .height = 1.0}});
    const int sky = add_two_sided(scene);
    scene.surfaces.push_back({.name = "dome", .material = sky, .shape = Sphere{{0, 0, 0}, radius}});
    const Found found = found_in(scene);
    const auto by_name = parts_by_name(scene, found);
    EXPECT_EQ(by_name.at("office").size(), 1u) << radius;
    EXPECT_EQ(by_name.at("dome").size(), 1u) << radius;
    EXPECT_NE(by_name.at("dome"), by_name.at("office")) << radius;
  }
}

// Each wall is more than ten times as large as the bulb, and around it on five sides, but beyond it
// on the sixth.
TEST(FindParts, AWallBesideABulbIsNoBackdrop) {
  Scene scene;
  const int wall = add_two_sided(scene), bulb = add_material(scene, diffuse(scene.bands, 0.5f));
  add_box(scene, {0, 0, 0}, {4, 5, 3}, {wall, wall, wall, wall, wall, wall}, true);
  add_box(scene, {1, 1.5, 1.2}, {1.1, 1.6, 1.3}, {bulb, bulb, bulb, bulb, bulb, bulb}, false);
  const Found found = found_in(scene);
  ASSERT_EQ(found.parts.count(), 2);
  expect_sides_apart(found, wall);
}

TEST(FindParts, ACabinetIsAPartAndACrackIsNone) {
  Scene scene;
  const int m = add_material(scene, diffuse(scene.bands, 0.5f)), board = add_two_sided(scene);
  add_box(scene, {0, 0, 0}, {4, 5, 3}, {m, m, m, m, m, m}, true);
  // A closed cabinet off the walls, and a book of 0.3 m x 0.2 m that lies 2 mm above the floor.
  add_box(scene, {1.0, 1.0, 0.3}, {1.6, 1.6, 2.3}, {board, board, board, board, board, board},
          false);
  add_box(scene, {2.5, 2.5, 0.002}, {2.8, 2.7, 0.05}, {m, m, m, m, m, m}, false);
  const Found found = found_in(scene);
  ASSERT_EQ(found.parts.count(), 2);
  EXPECT_NEAR(found.parts.parts[1].area, 2 * 0.36 + 4 * 1.2, 1e-6);
}

TEST(FindParts, TheInsideOfATableLegIsNone) {
  Scene scene;
  const int m = add_material(scene, diffuse(scene.bands, 0.5f)), wood = add_two_sided(scene);
  add_box(scene, {0, 0, 0}, {4, 5, 3}, {m, m, m, m, m, m}, true);
  // Off the floor, so that it is closed: 0.086 m2, less than 1/1024 of the room's 94 m2.
  add_box(scene, {1.0, 1.0, 0.3}, {1.03, 1.03, 1.0}, {wood, wood, wood, wood, wood, wood}, false);
  const Found found = found_in(scene);
  ASSERT_EQ(found.parts.count(), 1);
  // A sum of some 1000 patches of 94 m2 in all rounds by at most 1000 * 2^-53 * 94 = 1e-11.
  EXPECT_NEAR(found.parts.parts[0].area, 94.0 + 2 * (4 * 0.021 + 2 * 0.0009), 1e-11);
}

// A closed drawer of 0.4 m x 0.4 m x 0.1 m has 0.48 m2, 1/200 of the room's area, and rays of
// 4 V / A = 0.13 m, 1/19 of those in the room. A column of 0.3 m x 0.3 m x 2.9 m has 1/26 of the
// area, and rays of 0.29 m, 1/9 of those in the room. A booth in a low hall has 1/200 of the area
// as well, but rays of 0.8 m, 1/4 of those in the hall.
TEST(FindParts, AHollowIsNoneAndABoothIs) {
  const auto parts_of = [](const Eigen::Vector3d& room, const Eigen::Vector3d& body) {
    Scene scene;
    const int m = add_material(scene, diffuse(scene.bands, 0.5f)), board = add_two_sided(scene);
    add_box(scene, {0, 0, 0}, room, {m, m, m, m, m, m}, true);
    const Eigen::Vector3d low{1.0, 1.0, 0.01};
    add_box(scene, low, low + body, {board, board, board, board, board, board}, false);
    return found_in(scene).parts.count();
  };
  EXPECT_EQ(parts_of({4, 5, 3}, {0.4, 0.4, 0.1}), 1);
  EXPECT_EQ(parts_of({4, 5, 3}, {0.3, 0.3, 2.9}), 1);
  EXPECT_EQ(parts_of({30, 30, 2.1}, {1, 1, 2}), 2);
}

// Most rays of the outside get away, and those that meet a name plate are short: about 0.02 m,
// where 1/32 of the root of the area is 0.3 m.
TEST(FindParts, TheOutsideOfAHouseWithPlatesIsNoCrack) {
  Scene scene;
  const int wall = add_two_sided(scene), plate = add_two_sided(scene),
            floor = add_material(scene, diffuse(scene.bands, 0.5f));
  add_box(scene, {0, 0, 0}, {4, 5, 3}, {wall, wall, wall, wall, floor, wall}, true);
  for (int i = 0; i < 8; ++i) {
    const double y = 0.3 + 0.6 * i;
    add_polygon(scene, "plate", plate,
                {{4.01, y, 1.5}, {4.01, y + 0.1, 1.5}, {4.01, y + 0.1, 1.6}, {4.01, y, 1.6}});
  }
  const Found found = found_in(scene);
  ASSERT_EQ(found.parts.count(), 2);
  expect_sides_apart(found, wall);
}

TEST(FindParts, TheSizeOfTheSceneDoesNotMatter) {
  for (const double scale : {1e-3, 1e3}) {
    Scene scene = bright_and_dim(0.5), scaled = scene;
    for (Surface& surface : scaled.surfaces) {
      for (auto& vertex : std::get<PolygonMesh>(surface.shape).vertices) vertex *= scale;
    }
    EXPECT_EQ(found_in(scene).parts.of_patch, found_in(scaled).parts.of_patch);
  }
}

TEST(CutGraph, PartsTwoCliquesWithAWeakLink) {
  // 20 nodes of area 1 in two groups; each exchanges all its light with the others of its group,
  // but for the link of two of them.
  for (const float link : {0.0f, 0.2f, 2.0f}) {
    std::vector<ExchangeLink> links{{3, 14, link}};
    for (int i = 0; i < 20; ++i) {
      for (int j = i + 1; j < 20; ++j) {
        if (i / 10 == j / 10) links.push_back({i, j, 1.0f / 9.0f});
      }
    }
    const std::vector<int> part = cut_graph(ExchangeGraph(std::vector<double>(20, 1.0), links));
    // 0.2 of 10 is 2 %, and 2 of 10 is 20 %.
    EXPECT_EQ(std::set<int>(part.begin(), part.end()).size(), link < 1.0f ? 2u : 1u) << link;
    if (link < 1.0f) {
      for (int i = 0; i < 20; ++i) EXPECT_EQ(part[i], part[i / 10 * 10]);
    }
  }
}

}  // namespace
}  // namespace lightwell::find_parts_test
