// Commands never overwrite what they read, and names of any kind do no harm.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "radiosity/solution/solution_file.h"
#include "tests/cli/program.h"

namespace lightwell::inputs_test {
namespace {
using Words = std::vector<std::string>;
namespace fs = std::filesystem;

class Inputs : public CommandTest {
 protected:
  void SetUp() override {
    folder.write("cube.obj", "mtllib cube.mtl\nusemtl lamp\n" + unit_cube());
    folder.write("cube.mtl", "newmtl lamp\nKd 0.5 0.5 0.5\nKe 1 1 1\n");
    folder.write("room.toml", small_room());
    folder.write("points.csv", "x,y,z,nx,ny,nz\n1,1,0,0,0,1\n");
    const Words quiet{"--quiet"};
    ASSERT_EQ(run(Words{"solve", "room.toml", "-o", "room.vtp"} + quick() + quiet).code, 0);
    ASSERT_EQ(run(Words{"solve", "cube.obj", "-o", "cube.vtp"} + quick() + quiet).code, 0);
  }

  void expect_kept(const std::string& file, const Words& arguments) {
    SCOPED_TRACE(arguments.front() + " over " + file);
    const std::string before = content_of(folder / file);
    const int files = folder.file_count();
    const Ended ended = run(arguments);
    EXPECT_EQ(ended.code, 1) << ended.err;
    EXPECT_TRUE(says(ended.err, "name another output"));
    EXPECT_EQ(content_of(folder / file), before);
    EXPECT_EQ(folder.file_count(), files);
  }
};

TEST_F(Inputs, AreNeverReplaced) {
  expect_kept("cube.obj", {"form-factors", "cube.obj", "-o", "F.mtx", "--view3d", "cube.obj"});
  folder.write("grey.csv", "wavelength_nm,grey\n400,0.5\n700,0.5\n");
  folder.write("grey.toml",
               "[bands]\nkind = 'spectral'\ncount = 1\n"
               "[materials.grey]\nreflectance = { file = 'grey.csv' }\n"
               "[[surfaces]]\nmaterial = 'grey'\npolygon = [[0,0,0],[1,0,0],[0,1,0]]\n");
  expect_kept("grey.csv", {"form-factors", "grey.toml", "-o", "F.mtx", "--moose", "grey.csv"});
  expect_kept("points.csv",
              {"probe", "room.toml", "room.vtp", "--points", "points.csv", "-o", "points.csv"});
  expect_kept("cube.obj", {"export", "cube.vtp", "--scene", "cube.obj", "-o", "cube.obj"});
  expect_kept("room.vtp", {"solve", "room.toml", "--start-from", "room.vtp", "-o", "room.vtp"});
}

TEST_F(Inputs, AreKnownByEveryName) {
  fs::create_hard_link(folder / "points.csv", folder / "linked.csv");
  fs::create_symlink("points.csv", folder / "link.csv");
  for (const std::string output : {"linked.csv", "link.csv", "./points.csv"}) {
    expect_kept("points.csv",
                {"probe", "room.toml", "room.vtp", "--points", "points.csv", "-o", output});
  }
}

// All files of a scene are inputs: an export writes shelf.mtl beside shelf.obj.
TEST_F(Inputs, OfASceneAreAllItsFiles) {
  fs::create_directory(folder / "models");
  folder.write("models/shelf.obj", "mtllib ../shelf.mtl\nusemtl lamp\n" + unit_cube());
  folder.write("shelf.mtl", content_of(folder / "cube.mtl"));
  expect_kept("shelf.mtl",
              {"export", "cube.vtp", "--scene", "models/shelf.obj", "-o", "shelf.obj"});
}

TEST_F(Inputs, MaterialsThatNoExportWroteAreKept) {
  folder.write("out.mtl", "newmtl mine\n");
  const Words exports{"export", "cube.vtp", "-o", "out.obj", "--quiet"};
  expect_kept("out.mtl", exports);
  fs::remove(folder / "out.mtl");
  EXPECT_EQ(run(exports).code, 0);
  EXPECT_EQ(run(exports).code, 0) << "of an earlier export";
}

// The names are in Latin-1, and hold characters that terminals obey.
TEST_F(Inputs, OfAnyNameMakeReadableSolutions) {
  const std::string odd = "b\xfcro\x1b[31m";
  folder.write(odd + ".obj", "mtllib cube.mtl\no " + odd + "\nusemtl lamp\n" + unit_cube());
  const Ended solved =
      run(Words{"solve", odd + ".obj", "-o", "odd.vtp", "--channels", "per-luminaire"} + quick());
  EXPECT_EQ(solved.code, 0) << solved.err;
  EXPECT_EQ(solved.err.find('\x1b'), std::string::npos);
  const SolvedScene read = read_solution(folder / "odd.vtp");
  ASSERT_FALSE(read.solution.channels.empty());
  EXPECT_EQ(read.solution.channels.front().name.find('\x1b'), std::string::npos);
  EXPECT_EQ(run({"info", "odd.vtp"}).code, 0);
  EXPECT_EQ(run({"export", "odd.vtp", "-o", "odd.ply", "--quiet"}).code, 0);
}

// Every command that reads a scene refuses what lies outside of the scene's folder.
TEST_F(Inputs, StayInTheFolderOfTheSceneIfAskedTo) {
  fs::create_directory(folder / "own");
  folder.write("own/room.obj", "mtllib ../cube.mtl\nusemtl lamp\n" + unit_cube());
  const std::string scene = "own/room.obj";
  const std::vector<Words> commands = {
      {"run", scene},
      {"solve", scene, "-o", "a.vtp"},
      {"mesh", scene, "-o", "a.vtp"},
      {"render", scene, "cube.vtp", "-o", "a.png"},
      {"probe", scene, "cube.vtp", "--points", "points.csv", "-o", "a.csv"},
      {"report", scene, "cube.vtp", "-o", "a.html"},
      {"export", "cube.vtp", "--scene", scene, "-o", "a.obj"},
      {"info", scene}};
  for (const Words& command : commands) {
    SCOPED_TRACE(command.front());
    const Ended ended = run(command + Words{"--inside-folder"});
    EXPECT_EQ(ended.code, 3) << ended.err;
    EXPECT_TRUE(says(ended.err, "outside of its folder"));
  }
  folder.write("own/solar.toml",
               "[materials.a]\nreflectance = 0\n[[surfaces]]\nmaterial = 'a'\n"
               "mesh = '../cube.obj'\n");
  EXPECT_EQ(run({"form-factors", "own/solar.toml", "-o", "F.mtx", "--inside-folder"}).code, 3);
  EXPECT_EQ(run({"info", "cube.obj", "--inside-folder"}).code, 0);
}

// A link that is an output stays a link, and the file that it leads to is written.
TEST_F(Inputs, OutputsAreWrittenThroughLinks) {
  fs::create_directory(folder / "results");
  fs::create_symlink("results/points.csv", folder / "points-link.csv");
  const Words probe{"probe", "room.toml", "room.vtp", "--points", "points.csv", "--quiet", "-o"};
  for (const char* const output : {"points-link.csv", "points-link.csv"}) {  // absent, then there
    EXPECT_EQ(run(probe + Words{output}).code, 0);
    EXPECT_TRUE(fs::is_symlink(folder / "points-link.csv"));
    EXPECT_TRUE(fs::is_regular_file(folder / "results/points.csv"));
  }
  fs::create_symlink("nowhere/points.csv", folder / "astray.csv");
  const Ended ended = run(probe + Words{"astray.csv"});
  EXPECT_EQ(ended.code, 1);
  EXPECT_TRUE(says(ended.err, "there is no folder"));
}

// Pictures are called after cameras, and names of files have at most 255 bytes.
TEST_F(Inputs, NamesOfCamerasMakeNamesOfFiles) {
  std::string room = small_room();
  room.insert(room.find("door\""), 300, 'd');
  folder.write("long.toml", room);
  const Ended ended = run({"run", "long.toml", "-o", "pictures"});
  EXPECT_EQ(ended.code, 3);
  EXPECT_TRUE(says(ended.err, "give at most 200"));
  EXPECT_FALSE(fs::exists(folder / "pictures"));
}

}  // namespace
}  // namespace lightwell::inputs_test
