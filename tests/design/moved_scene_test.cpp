#include "design/moved_scene.h"

#include <gtest/gtest.h>

#include <string>

#include "scene/io/read_scene.h"
#include "tests/temporary_folder.h"

namespace lightwell::moved_scene_test {
namespace {

const std::string web = R"(IESNA:LM-63-2002
TILT=NONE
1 1000 1 3 1 1 2 0 0 0 1 1 10
0 45 90
0
100 80 0
)";

/// Lamps of a file in centimetres, with comments and letters of several bytes before places.
const std::string text = R"(unit = "cm"
[materials.grau]
reflectance = 0.5  # größer
[[surfaces]]
name = "Zimmer"
material = "grau"
box = { min = [0, 0, 0], max = [400, 300, 250], inward = true }
[[lamps]]
name = "Düse"
file = "luminaires/spot.ies"
position = [100, 120.5, 240]   # oben
aim = [0, 0, -1]
[[lamps]]
position = [
  200,  # x
  150, 240]
candela = 10
[[lamps]]
position = [310.1, 20.7, 200]
look_at = [100.3, 150, 0.1]
cone = [20, 30]
lumens = 100
)";

TEST(MovedScene, ReadsAsTheSceneWithItsLampsMoved) {
  const TemporaryFolder folder;
  std::filesystem::create_directory(folder / "luminaires");
  std::filesystem::create_directory(folder / "out");
  folder.write("luminaires/spot.ies", web);
  Scene scene = read_scene(folder.write("room.toml", text));
  scene.lamps[0].position.x() = scene.metres_per_unit * 87.654321;
  scene.lamps[1].position.y() = scene.metres_per_unit * 33.25;
  scene.lamps[2].position.x() = scene.metres_per_unit * 299.9;
  const auto moved = moved_scene_text(scene, folder / "out");
  ASSERT_TRUE(moved);
  EXPECT_NE(moved->find("position = [87.654321, 120.5, 240]   # oben"), std::string::npos)
      << *moved;
  EXPECT_NE(moved->find("  200,  # x\n  33.25, 240]"), std::string::npos) << *moved;
  EXPECT_NE(moved->find("file = \"../luminaires/spot.ies\""), std::string::npos) << *moved;
  EXPECT_EQ(moved->find("look_at"), std::string::npos) << "the lamp keeps its direction\n"
                                                       << *moved;
  const Scene again = read_scene(folder.write("out/moved.toml", *moved));
  EXPECT_EQ(scene_hash(again), scene_hash(scene));
}

TEST(MovedScene, WithoutMovesIsTheFileItself) {
  const TemporaryFolder folder;
  std::filesystem::create_directory(folder / "luminaires");
  folder.write("luminaires/spot.ies", web);
  const Scene scene = read_scene(folder.write("room.toml", text));
  EXPECT_EQ(moved_scene_text(scene, folder / ""), text);
}

TEST(MovedScene, IsNotWrittenInOtherFormats) {
  Scene scene;
  scene.file = "room.obj";
  EXPECT_FALSE(moved_scene_text(scene, "."));
}

}  // namespace
}  // namespace lightwell::moved_scene_test
