// Projects for rad (.rif), and views in projects or beside a scene.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "scene/errors.h"
#include "scene/io/read_scene.h"
#include "tests/scene/scene_questions.h"
#include "tests/temporary_folder.h"

namespace lightwell::radiance_views_test {
namespace {

using test::has_note;
using test::notes_of;

class RadianceProjects : public testing::Test {
 protected:
  RadianceProjects() {
    folder.write("grey.mat", "void plastic grey 0 0 5 .5 .5 .5 0 0\n");
    folder.write("room.rad", "grey polygon square 0 0 12 0 0 0 8 0 0 8 6 0 0 6 0\n");
  }
  Scene read(const std::string& variables) const {
    return read_scene(
        folder.write("room.rif", "materials= grey.mat\nscene= room.rad\n" + variables));
  }
  Camera camera(const std::string& variables) const { return read(variables).cameras.at(0); }
  std::string error(const std::string& variables) const {
    return message_of<InputError>([&] { read(variables); });
  }
  TemporaryFolder folder;
};

void expect_near(const Eigen::Vector3d& a, const Eigen::Vector3d& b, double tolerance = 1e-12) {
  EXPECT_LT((a - b).norm(), tolerance) << a.transpose() << " is not " << b.transpose();
}

TEST_F(RadianceProjects, VariablesMayBeCutShortJoinedAndCommented) {
  const Scene scene = read(
      "scen = '!genbox grey box 1 1 1 | xform -t 1 1 1' \\\n  room.rad # twice\n"
      "QUAL=Medium\nobj = a b\nview = v1 -vp 1 2 3 -vd 0 0 -1 -vu 0 1 0\n");
  ASSERT_EQ(scene.surfaces.size(), 3u);
  EXPECT_EQ(scene.surfaces[1].name, "box");
  EXPECT_EQ(scene.surfaces[2].name, "square 2");
  EXPECT_TRUE(has_note(scene, "no effect here: 'QUALITY'"));
}

TEST_F(RadianceProjects, AViewIsItsOptions) {
  const Camera v = camera("RES= 640\nUP= Z\nview = door -vp 1 2 3 -vd 2 0 0 -vh 60 -vv 40\n");
  EXPECT_EQ(v.name, "door");
  expect_near(v.position, {1, 2, 3});
  expect_near(v.direction, {1, 0, 0});
  expect_near(v.up, {0, 0, 1});
  EXPECT_DOUBLE_EQ(v.fov_degrees, 60.0);
  EXPECT_EQ(v.width, 640);
  const double degree = std::numbers::pi / 180;
  EXPECT_EQ(v.height, std::lround(640 * std::tan(20 * degree) / std::tan(30 * degree)));
}

TEST_F(RadianceProjects, TheLastLineOfAViewFileCounts) {
  folder.write("door.vf",
               "rvu -vtv -vp 1 2 3 -vd 0 1 0 -vu 0 0 1 -vh 45 -vv 45\nnot a view -vp 7 7 7\n"
               "VIEW= -vp 4 5 6\n");
  const Camera v = camera("view = door -vf door.vf -vh 50\n");
  expect_near(v.position, {4, 5, 6});
  expect_near(v.direction, {0, 1, 0});
  EXPECT_DOUBLE_EQ(v.fov_degrees, 50.0);
}

TEST_F(RadianceProjects, StandardViewsLookFromTheZonesSides) {
  const std::string zone = "ZONE= I 0 10 0 10 0 10\n";
  const Camera from_x = camera(zone + "view= X\n");
  expect_near(from_x.position, {9.5, 5, 5});
  expect_near(from_x.direction, {-1, 0, 0});
  const Camera corner = camera(zone + "view= xy\nUP= Z\n");
  expect_near(corner.position, {0.5, 0.5, 5});
  const Camera down = camera(zone + "view= Z\nUP= Z\n");
  expect_near(down.direction, {0, 0, -1});
  expect_near(down.up, {0, 1, 0});
  expect_near(camera("").direction, {-1, 0, 0});  // rad's default view of the scene's bounds
  expect_near(camera("view= Z\nUP= Y\n").direction, {0, 0, -1});  // the scene is flat in z
}

TEST_F(RadianceProjects, OtherProjectionsAreLeftOutByName) {
  const Scene scene = read("view= fish -vth -vh 180 -vv 180\nview= plain -vd 0 0 -1 -vu 0 1 0\n");
  ASSERT_EQ(scene.cameras.size(), 1u);
  EXPECT_TRUE(has_note(scene, "were left out: 'fish'"));
}

TEST_F(RadianceProjects, ASceneTakesTheViewsOfTheFileBesideIt) {
  folder.write("alone.rad", "!cat grey.mat room.rad\n");
  folder.write("alone.vf", "rvu -vp 1 2 3 -vd 0 0 -1 -vu 0 1 0 -x 100 -y 50\nrvu -vp 4 5 6\n");
  const Scene scene = read_scene(folder / "alone.rad");
  ASSERT_EQ(scene.cameras.size(), 2u);
  EXPECT_EQ(scene.cameras[0].name, "alone");
  EXPECT_EQ(scene.cameras[0].width, 50);  // both angles are 45 degrees
  expect_near(scene.cameras[1].position, {4, 5, 6});
}

TEST_F(RadianceProjects, WrongProjectsAreNamedWithFileAndLine) {
  const auto wrong = [&](const std::string& variables, const std::string& says_this) {
    EXPECT_TRUE(says(error(variables), says_this)) << variables;
  };
  wrong("vew = X\n", "room.rif:3: there is no variable 'vew'. Did you mean 'view'?");
  wrong("scene= *.rad\n", "uses '*'");
  wrong("UP= W\n", "write X, Y or Z");
  wrong("RES= none\n", "one or two numbers of pixels");
  const auto only = [&](const std::string& text) {
    return message_of<InputError>([&] { read_scene(folder.write("only.rif", text)); });
  };
  EXPECT_TRUE(says(only("OCTREE= room.oct\n"), "an octree alone cannot be read"));
  EXPECT_TRUE(says(only(""), "'scene' names no files"));
}

TEST_F(RadianceProjects, PartsThatCannotBeUsedAreLeftOutWithTheirPlace) {
  const auto noted = [&](const std::string& variables, const std::string& says_this) {
    const Scene scene = read(variables);
    EXPECT_EQ(scene.surfaces.size(), 1u);
    EXPECT_TRUE(says(notes_of(scene), says_this)) << variables;
    EXPECT_FALSE(scene.losses.empty());
  };
  noted("scene= nothing.rad\n", "room.rif:3: names the file 'nothing.rad'");
  noted("ZONE= I 0 1\nview= X\n", "write 'I x0 x1 y0 y1 z0 z1'");
  noted("view= v -vp 1 2\n", "the view's option '-vp' lacks a number");
  noted("view= v -vh 200\n", "spans 200 degrees");
  noted("view= v -vd 0 0 1\n", "looks along its upright");
  noted("view= v -vf none.vf\n", "no such file");
  noted("view= v -vf room.rad\n", "holds no view");
}

}  // namespace
}  // namespace lightwell::radiance_views_test
