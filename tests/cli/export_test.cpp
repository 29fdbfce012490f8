// Files and errors of 'lightwell export'.
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "scene/io/read_scene.h"
#include "tests/cli/program.h"

namespace lightwell::export_test {
namespace {
using Words = std::vector<std::string>;

class ExportCommand : public CommandTest {
 protected:
  void SetUp() override {
    folder.write("room.toml", small_room());
    const Ended solved = run(Words{"solve", "room.toml", "-o", "room.vtp", "--quiet"} + quick());
    ASSERT_EQ(solved.code, 0) << solved.err;
  }
  void expect_refused(const Words& arguments, int code, const std::string& sentence) {
    const int files = folder.file_count();
    const Ended ended = run(arguments);
    EXPECT_EQ(ended.code, code) << ended.err;
    EXPECT_TRUE(says(ended.err, sentence));
    EXPECT_EQ(ended.out, "");
    EXPECT_EQ(folder.file_count(), files);
  }
};

TEST_F(ExportCommand, WritesEveryFormatAtOnce) {
  const auto json = run_json({"export", "room.vtp", "--scene", "room.toml", "-o", "a.glb", "-o",
                              "a.ply", "-o", "a.obj", "-o", "a.HTML"});
  EXPECT_EQ(json["files"], nlohmann::json::array({"a.glb", "a.ply", "a.mtl", "a.obj", "a.HTML"}));
  for (const auto& file : json["files"]) {
    EXPECT_TRUE(std::filesystem::exists(folder / file.get<std::string>())) << file;
  }
  EXPECT_GT(json["exported"]["faces"].get<int>(), 0);
  EXPECT_LE(json["exported"]["faces"].get<int>(), json["elements"].get<int>());
  const Scene glb = read_scene(folder / "a.glb");
  ASSERT_EQ(glb.cameras.size(), 1u);
  EXPECT_EQ(glb.cameras[0].name, "door");
}

/// The room is lit from inside only: the model lacks the outer sides of the walls.
TEST_F(ExportCommand, TheModelHasTheAreaOfTheRoomsLitSides) {
  ASSERT_EQ(run({"export", "room.vtp", "--scene", "room.toml", "-o", "a.ply", "--quiet"}).code, 0);
  double area = 0.0, wanted = 0.0;
  for (const Surface& surface : read_scene(folder / "a.ply").surfaces)
    area += surface_area(surface);
  for (const Surface& s : read_scene(folder / "room.toml").surfaces) wanted += surface_area(s);
  EXPECT_GE(area, wanted * (1 - 1e-5));  // single precision; the panel may have both sides
  EXPECT_LE(area, 2 * wanted);
}

TEST_F(ExportCommand, WithoutItsSceneSurfacesHaveNumbers) {
  const Ended ended = run({"export", "room.vtp", "-o", "a.glb"});
  EXPECT_EQ(ended.code, 0) << ended.err;
  EXPECT_TRUE(says(ended.err, "'--scene SCENE' does"));
  const Scene glb = read_scene(folder / "a.glb");
  EXPECT_TRUE(glb.cameras.empty());
  EXPECT_TRUE(says(glb.surfaces[0].name, "surface "));
}

TEST_F(ExportCommand, IsTheSameForAnyNumberOfThreads) {
  for (const char* threads : {"1", "3"}) {
    ASSERT_EQ(
        run({"export", "room.vtp", "--scene", "room.toml", "-o", std::string(threads) + ".html",
             "-o", std::string(threads) + ".glb", "--threads", threads, "--quiet"})
            .code,
        0);
  }
  EXPECT_EQ(content_of(folder / "1.html"), content_of(folder / "3.html"));
  EXPECT_EQ(content_of(folder / "1.glb"), content_of(folder / "3.glb"));
}

TEST_F(ExportCommand, WritesLightmapsThatAreTheSameForAnyNumberOfThreads) {
  for (const char* pass : {"interpolate", "direct"}) {
    for (const char* threads : {"1", "3"}) {
      const auto json = run_json({"export", "room.vtp", "--scene", "room.toml", "-o",
                                  std::string(threads) + ".glb", "--lightmap", "--lightmap-size",
                                  "128", "--lightmap-pass", pass, "--threads", threads});
      EXPECT_EQ(json["files"], nlohmann::json::array({std::string(threads) + "-lightmap-1.exr",
                                                      std::string(threads) + ".glb"}));
      EXPECT_EQ(json["lightmap"]["size"], 128);
      EXPECT_GT(json["lightmap"]["coverage"].get<double>(), 0.3);
    }
    EXPECT_EQ(content_of(folder / "1-lightmap-1.exr"), content_of(folder / "3-lightmap-1.exr"));
    // The models differ in the names of their lightmaps alone.
    EXPECT_EQ(content_of(folder / "1.glb").size(), content_of(folder / "3.glb").size());
  }
}

TEST_F(ExportCommand, RefusesLightmapsThatCannotBe) {
  const auto refused = [&](const Words& more, int code, const std::string& sentence) {
    expect_refused(Words{"export", "room.vtp", "-o", "a.glb"} + more, code, sentence);
  };
  refused({"--lightmap-size", "512"}, 2, "--lightmap");
  refused({"--lightmap", "--lightmap-size", "8"}, 2, "16");
  refused({"--lightmap", "--lightmap-size", "100000"}, 2, "8192");
  refused({"--lightmap", "--texels-per-metre", "0"}, 2, "--texels-per-metre");
  refused({"--lightmap", "--texels-per-metre", "nan"}, 2, "--texels-per-metre");
  refused({"--lightmap", "--lightmap-pass", "direct"}, 2, "--scene SCENE");
  refused({"--lightmap", "--lightmap-size", "16"}, 3, "take size");
  refused({"--lightmap", "--texels-per-metre", "1e6"}, 3, "at most");
  expect_refused({"export", "room.vtp", "-o", "a.ply", "--lightmap"}, 2, "-o FILE.glb");
  std::filesystem::create_directory(folder / "a-lightmap-1.exr");
  refused({"--lightmap"}, 1, "it is a folder");
}

TEST_F(ExportCommand, RefusesOptionsThatNoOutputFollows) {
  expect_refused({"export", "room.vtp", "-o", "b.html", "--sides", "both"}, 2, "add '-o FILE.glb'");
  expect_refused({"export", "room.vtp", "-o", "b.glb", "--white-balance", "auto"}, 2,
                 "add '-o FILE.html'");
}

TEST_F(ExportCommand, SetsTheFirstWhiteBalanceOfThePage) {
  const auto page_with = [&](const Words& white) {
    const Ended ended = run(Words{"export", "room.vtp", "-o", "a.html", "--quiet"} + white);
    EXPECT_EQ(ended.code, 0) << ended.err;
    return content_of(folder / "a.html");
  };
  EXPECT_TRUE(says(page_with({}), "\"first\":\"as-lit\""));
  EXPECT_TRUE(says(page_with({"--white-balance", "auto"}), "\"first\":\"auto\""));
  const std::string warm = page_with({"--white-balance", "2850K"});
  EXPECT_TRUE(says(warm, "\"first\":2850.0"));
  EXPECT_TRUE(says(warm, "{\"kelvin\":2850.0,")) << "a choice of the page";
  expect_refused({"export", "room.vtp", "-o", "b.html", "--white-balance", "warm"}, 2,
                 "'as-lit', 'auto' or a temperature from 2000K to 40000K is needed, not 'warm'");
}

TEST_F(ExportCommand, RefusesWhatItCannotWrite) {
  expect_refused({"export", "room.vtp", "-o", "a.fbx"}, 2, ".glb");
  expect_refused({"export", "room.vtp"}, 2, "-o");
  expect_refused({"export", "room.vtp", "-o", "nowhere/a.glb"}, 1, "there is no folder 'nowhere'");
  std::filesystem::create_directory(folder / "taken.html");
  expect_refused({"export", "room.vtp", "-o", "taken.html"}, 1, "it is a folder");
  std::filesystem::create_directory(folder / "b.mtl");  // the material file of b.obj
  expect_refused({"export", "room.vtp", "-o", "b.obj"}, 1, "b.mtl");
  expect_refused({"export", "room.vtp", "-o", "a.html", "--range", "5:1"}, 2, "is no range");
}

TEST_F(ExportCommand, RefusesSolutionsThatAreNone) {
  const std::string whole = content_of(folder / "room.vtp");
  folder.write("torn.vtp", whole.substr(0, whole.size() / 2));
  folder.write("empty.vtp", "");
  expect_refused({"export", "torn.vtp", "-o", "a.glb"}, 3, "torn.vtp");
  expect_refused({"export", "empty.vtp", "-o", "a.html"}, 3, "empty");
  expect_refused({"export", "missing.vtp", "-o", "a.ply"}, 3, "missing.vtp");
}

TEST_F(ExportCommand, RefusesTheSceneOfAnotherSolution) {
  folder.write("cube.obj", unit_cube());
  expect_refused({"export", "room.vtp", "--scene", "cube.obj", "-o", "a.glb"}, 3, "was made from");
}

}  // namespace
}  // namespace lightwell::export_test
