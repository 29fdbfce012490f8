#include "scene/io/scene_text.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "scene/errors.h"
#include "scene/io/polygon_arrays.h"
#include "scene/io/text_file.h"
#include "tests/scene/expected_messages.h"

namespace lightwell::scene_text_test {
namespace {

const std::filesystem::path folder = LIGHTWELL_TEST_DATA "/scene";

SceneText text_of(const char* name) {
  return {.text = TextFile(folder / name).text(), .folder = folder};
}

const std::string floor_and_lamp = R"(
materials.grey = { reflectance = 0.5 }
surfaces = [{ name = "floor", material = "grey", polygon = [[0,0,0],[2,0,0],[2,1,0],[0,1,0]] }]
lamps = [{ name = "bulb", position = [1, 0.5, 2], lumens = 800 }]
)";

std::string message_of(const std::string& text, const std::filesystem::path& where = {}) {
  try {
    read_scene_text({.text = text, .folder = where});
  } catch (const InputError& error) {
    return error.what();
  }
  return "nothing was thrown";
}

TEST(SceneText, IsTheSceneOfTheFileWithTheSameText) {
  const Scene theirs = read_scene(folder / "everything.toml");
  const Scene ours = read_scene_text(text_of("everything.toml"));
  EXPECT_EQ(scene_hash(ours), scene_hash(theirs));
  EXPECT_EQ(ours.notes, theirs.notes);
  EXPECT_EQ(ours.cameras.size(), theirs.cameras.size());
  EXPECT_TRUE(ours.file.empty());
}

TEST(SceneText, MessagesNameTableAndKeyWithoutAPlaceInAFile) {
  EXPECT_EQ(message_of(floor_and_lamp + "sky = { kind = \"blue\" }").find("kind of sky is 'blue'"),
            0u)
      << message_of(floor_and_lamp + "sky = { kind = \"blue\" }");
  EXPECT_EQ(message_of(floor_and_lamp + "heaven = 1").find("unknown key 'heaven'"), 0u)
      << message_of(floor_and_lamp + "heaven = 1");
}

TEST(SceneText, FilesThatItNamesAreRelativeToTheFolder) {
  const std::string lamp = "lamps = [{ file = \"nowhere.ies\", position = [0, 0, 1] }]\n";
  const std::string floor = floor_and_lamp.substr(0, floor_and_lamp.find("lamps"));
  const std::string message = message_of(lamp + floor, folder);
  EXPECT_NE(message.find((folder / "nowhere.ies").string()), std::string::npos) << message;
}

TEST(SceneText, SurfacesMayComeFromElsewhere) {
  const std::string text = floor_and_lamp.substr(0, floor_and_lamp.find("surfaces")) +
                           "grids = [{ surface = \"floor\", height = 0.8 }]";
  const Scene scene = read_scene_text({.text = text}, [](Scene& made) {
    made.surfaces = {{.name = "floor", .material = 0}};
    const PolygonArrays square{.vertices = {{0, 0, 0}, {2, 0, 0}, {2, 1, 0}, {0, 1, 0}},
                               .corners = {0, 1, 2, 3},
                               .first = {0, 4},
                               .surface = {0},
                               .uv = {{0, 1}, {1, 1}, {1, 0}, {0, 0}}};
    made = scene_of_polygons(std::move(made), square).scene;
  });
  EXPECT_EQ(surface_area(scene.surfaces[0]), 2.0);
  const LightingDesign design = read_lighting_text({.text = text}, scene);
  ASSERT_EQ(design.grids.size(), 1u);
  EXPECT_EQ(design.grids[0].height, 0.8);
  // Texture coordinates that no picture uses are dropped, as those of a file.
  EXPECT_TRUE(std::get<PolygonMesh>(scene.surfaces[0].shape).uv_maps.empty());
}

TEST(CameraText, HasMetresWhateverTheUnitOfTheScene) {
  const Scene millimetres = read_scene_text({.text = "unit = \"mm\"\n" + floor_and_lamp});
  const Camera camera = read_camera_text(
      "position = [1, 2, 3]\ndirection = [0, 0, -1]\nup = [0, 1, 0]\nnear = 0.5", millimetres);
  EXPECT_EQ(camera.position, Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ(camera.near_distance, 0.5);
}

}  // namespace
}  // namespace lightwell::scene_text_test
