#include "scene/motion.h"

#include <cmath>
#include <limits>

#include "scene/errors.h"
#include "scene/place_at_rest.h"
#include "tests/scene/scene_file_test.h"

namespace lightwell::motion_test {
namespace {

using Eigen::Vector3d;

class Motions : public test::SceneFileTest {
 protected:
  static std::string scene_text(const std::string& motion, const std::string& cameras,
                                const std::string& material = "reflectance = 0.5") {
    return "[materials.m]\n" + material + "\n[motions.spin]\n" + motion +
           "\n[[surfaces]]\nname = \"blade\"\nmotion = \"spin\"\nmaterial = \"m\"\n"
           "polygon = [[1, 0, 0], [2, 0, 0], [2, 0, 1]]\n" +
           cameras;
  }
  static std::string camera(const std::string& more) {
    return "[[cameras]]\nposition = [0, 0, 9]\nlook_at = [0, 0, 0]\n" + more + "\n";
  }
  // Message of the error that reading the text throws.
  std::string failure(const std::string& text) {
    try {
      read_file("scene.toml", text);
    } catch (const InputError& error) {
      return error.what();
    }
    return "none";
  }
};

const char* const half_turn =
    "axis = [0, 0, 2]\nkeys = [{time = 0}, {time = 1, degrees = 180, translate = [0, 0, 4]}]";

TEST(RigidMotion, TurnsAndMovesEvenlyBetweenKeys) {
  const RigidMotion motion{
      .pivot = {1, 0, 0},
      .keys = {{.time = 1.0}, {.time = 3.0, .degrees = 720.0, .translation = {0, 0, 8}}}};
  EXPECT_TRUE(fault(motion).empty());
  EXPECT_LT((motion.pose(0.5) * Vector3d(2, 0, 0) - Vector3d(2, 0, 0)).norm(), 1e-12) << "before";
  EXPECT_LT((motion.pose(1.25) * Vector3d(2, 0, 0) - Vector3d(1, 1, 1)).norm(), 1e-12);
  EXPECT_LT((motion.pose(2.0) * Vector3d(2, 0, 0) - Vector3d(2, 0, 4)).norm(), 1e-12);
  EXPECT_LT((motion.pose(9.0) * Vector3d(2, 0, 0) - Vector3d(2, 0, 8)).norm(), 1e-12) << "after";
}

TEST(RigidMotion, IsNothingAtItsRest) {
  const RigidMotion motion{.keys = {{}, {.time = 1.0, .degrees = 90.0, .translation = {1, 2, 3}}},
                           .rest_time = 0.3};
  EXPECT_TRUE(motion.at(0.3).matrix().isIdentity(1e-12));
  const Vector3d p(4, 5, 6);
  EXPECT_LT((motion.at(0.8) * (motion.pose(0.3) * p) - motion.pose(0.8) * p).norm(), 1e-12);
}

TEST(RigidMotion, FaultsAreNamed) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const auto of = [](std::vector<MotionKey> keys) { return fault({.keys = std::move(keys)}); };
  EXPECT_NE(of({{}}).find("one key"), std::string::npos);
  EXPECT_NE(of({}).find("no keys"), std::string::npos);
  EXPECT_NE(of({{}, {.time = 0.0}}).find("ascend"), std::string::npos);
  EXPECT_NE(of({{}, {.time = nan}}).find("not finite"), std::string::npos);
  EXPECT_NE(of({{}, {.time = 1.0, .translation = {nan, 0, 0}}}).find("not finite"),
            std::string::npos);
  EXPECT_FALSE(fault({.axis = {0, 0, 0}, .keys = {{}, {.time = 1.0}}}).empty());
}

TEST_F(Motions, SurfacesRestInTheMiddleOfTheShutter) {
  const Scene scene = read_file("scene.toml", scene_text(half_turn, camera("shutter = [0.4, 0.6]") +
                                                                        camera("name = \"two\"")));
  ASSERT_EQ(scene.motions.size(), 1u);
  EXPECT_EQ(scene.motions[0].rest_time, 0.5);
  EXPECT_EQ(scene.surfaces[0].motion, 0);
  const auto& mesh = std::get<PolygonMesh>(scene.surfaces[0].shape);
  EXPECT_LT((mesh.vertices[0] - Vector3d(0, 1, 2)).norm(), 1e-12);
  EXPECT_EQ(scene.cameras[1].shutter_middle(), 0.5) << "an instant of the same time";
  EXPECT_FALSE(scene.cameras[1].is_open_for_a_while());
  ASSERT_EQ(scene.notes.size(), 1u);
  EXPECT_NE(scene.notes[0].find("0.5 s, the middle of the shutter: 'blade'"), std::string::npos)
      << scene.notes[0];
}

TEST_F(Motions, CamerasMoveToo) {
  const Scene scene = read_file(
      "scene.toml",
      scene_text(half_turn, camera("shutter = [0, 1]\nmotion = \"spin\"\nup = [0, 1, 0]")));
  EXPECT_LT((scene.cameras[0].position - Vector3d(0, 0, 11)).norm(), 1e-12);
  EXPECT_LT((scene.cameras[0].up - Vector3d(-1, 0, 0)).norm(), 1e-12);
  // Back to the file, and to the rest again.
  const Camera back = placed_as_in_file(scene, scene.cameras[0]);
  EXPECT_LT((back.position - Vector3d(0, 0, 9)).norm(), 1e-12);
  EXPECT_LT((back.up - Vector3d(0, 1, 0)).norm(), 1e-12);
  Camera again = back;
  place_at_rest(scene, again);
  EXPECT_LT((again.position - scene.cameras[0].position).norm(), 1e-12);
}

TEST_F(Motions, WhatCannotBeIsRefused) {
  const auto has = [&](const std::string& text, const std::string& words) {
    const std::string what = failure(text);
    EXPECT_NE(what.find(words), std::string::npos) << what;
  };
  has(scene_text(half_turn, camera("shutter = [1, 0]")), "before it has opened");
  has(scene_text(half_turn, camera("shutter = [0, nan]")), "finite");
  has(scene_text(half_turn, camera("shutter = [0]")), "two times");
  has(scene_text("keys = [{time = 0}]", camera("")), "one key");
  has(scene_text("keys = [{time = 0}, {time = inf}]", camera("")), "finite");
  has(scene_text("axis = [0, 0, 0]\nkeys = [{time = 0}, {time = 1}]", camera("")), "no length");
  has(scene_text(half_turn, camera("motion = \"spun\"")), "Did you mean 'spin'");
  has(scene_text(half_turn, camera("shutter = [0, 1]") + camera("name = \"b\"\nshutter = [0, 2]")),
      "one instant");
  has(scene_text(half_turn, "", "radiance = 5.0"), "lamp stand still");
}

}  // namespace
}  // namespace lightwell::motion_test
