// Projects for rad (.rif), and views in projects or beside a scene.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "scene/errors.h"
#include "scene/io/radiance/radiance_view.h"
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

TEST_F(RadianceProjects, EveryTypeOfViewIsACamera) {
  const std::string place = " -vp 1 2 3 -vd 0 1 0 -vu 0 0 1 ";
  const auto view = [&](const std::string& options) {
    return camera("RES= 400\nview = v " + place + options + "\n");
  };
  const double degree = std::numbers::pi / 180;
  const Camera parallel = view("-vtl -vh 8 -vv 4 -vo 0.5 -va 20");
  EXPECT_EQ(parallel.projection, Projection::orthographic);
  EXPECT_DOUBLE_EQ(parallel.view_width, 8.0);
  EXPECT_EQ(parallel.height, 200);
  EXPECT_DOUBLE_EQ(parallel.near_distance, 0.5);
  EXPECT_DOUBLE_EQ(parallel.far_distance, 20.0);
  const Camera angular = view("-vta -vh 180 -vv 90");
  EXPECT_EQ(angular.projection, Projection::equidistant);
  EXPECT_DOUBLE_EQ(angular.fov_degrees, 180.0);
  EXPECT_DOUBLE_EQ(angular.circle_degrees, 180.0);
  EXPECT_EQ(angular.height, 200);
  const Camera hemispherical = view("-vth -vh 180 -vv 60");
  EXPECT_EQ(hemispherical.projection, Projection::hemispherical);
  EXPECT_EQ(hemispherical.height, 200);  // sin 30 degrees of sin 90
  const Camera planispheric = view("-vts -vh 180 -vv 120");
  EXPECT_EQ(planispheric.projection, Projection::stereographic);
  EXPECT_EQ(planispheric.height, std::lround(400 * std::tan(30 * degree)));
  const Camera cylinder = view("-vtc -vh 360 -vv 90 -vs 0.25 -vl -0.5");
  EXPECT_EQ(cylinder.projection, Projection::cylindrical);
  EXPECT_EQ(cylinder.height, std::lround(400 / std::numbers::pi));
  EXPECT_EQ(cylinder.shift, Eigen::Vector2d(0.25, -0.5));
}

TEST_F(RadianceProjects, ViewsOfPicturesAreReadAsTheCamerasThatMadeThem) {
  for (const NamedProjection& kind : named_projections) {
    Camera made{.position = {1, 2, 3},
                .direction = Eigen::Vector3d(1, 2, -0.5).normalized(),
                .width = 300,
                .height = 300};
    made.up = made.direction.cross(Eigen::Vector3d::UnitX()).normalized();
    made = with_projection(made, kind.projection);
    if (kind.projection == Projection::perspective) {
      made.shift = {0.2, 0.1};
      made.window = {.left = 0.1, .top = 0.2, .right = 0.6, .bottom = 0.7};
      set_picture_size(300, 300, made);
    }
    made.near_distance = 0.25;
    const std::string options = radiance_view_options(made, 1.0);
    const bool has_view = kind.projection != Projection::equisolid &&
                          kind.projection != Projection::equirectangular &&
                          kind.projection != Projection::stereo_panorama &&
                          kind.projection != Projection::cube_map;
    EXPECT_EQ(!options.empty(), has_view) << kind.name;
    if (!has_view) continue;
    const Camera read_back =
        camera("RES= " + std::to_string(made.width) + "\nview = v " + options + "\n");
    EXPECT_EQ(read_back.projection, made.projection);
    EXPECT_EQ(read_back.width, made.width);
    EXPECT_EQ(read_back.height, made.height);
    // Options have nine digits.
    expect_near(read_back.position, made.position, 1e-8);
    expect_near(read_back.direction, made.direction, 1e-8);
    expect_near(read_back.up, made.up, 1e-8);
    EXPECT_DOUBLE_EQ(read_back.near_distance, 0.25);
    if (kind.projection == Projection::orthographic) {
      EXPECT_NEAR(read_back.view_width, made.view_width, 1e-8);
    } else if (kind.projection == Projection::perspective) {
      // Half of the width of the whole, moved by its middle, 0.35 - 0.5 + 0.2, and upwards by 0.1
      // less the 0.45 - 0.5 that it lies above the middle.
      EXPECT_NEAR(std::tan(read_back.fov_degrees * std::numbers::pi / 360),
                  0.5 * std::tan(made.fov_degrees * std::numbers::pi / 360), 1e-8);
      EXPECT_LT((read_back.shift - Eigen::Vector2d(0.1, 0.3)).norm(), 1e-8);
    } else {
      EXPECT_NEAR(read_back.fov_degrees, made.fov_degrees, 1e-6);
    }
  }
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
  noted("view= v -vth -vh 200\n", "lie between 0 and 180");
  noted("view= v -vtl -vh 0\n", "is not wide or not high");
  noted("view= v -vtx\n", "the unknown type '-vtx'");
  noted("view= v -vo 3 -va 2 -vd 0 0 -1 -vu 0 1 0\n", "must lie behind the beginning");
  noted("view= v -vd 0 0 1\n", "looks along its upright");
  noted("view= v -vf none.vf\n", "no such file");
  noted("view= v -vf room.rad\n", "holds no view");
}

}  // namespace
}  // namespace lightwell::radiance_views_test
