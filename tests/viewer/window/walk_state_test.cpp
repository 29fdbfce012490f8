#include "viewer/window/walk_state.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

namespace lightwell::walk_state_test {
namespace {

constexpr double degree = std::numbers::pi / 180.0;

Camera level_camera() {
  Camera camera;
  camera.position = {1, 1.6, 0};
  camera.direction = {0, 0, -1};
  camera.up = {0, 1, 0};
  return camera;
}

WalkState walk_from(const Camera& camera) {
  return {camera, Eigen::Vector3d::UnitY(), 1.5};
}

TEST(WalkState, WhereAWalkEndsDoesNotDependOnTheFrameRate) {
  WalkState smooth = walk_from(level_camera());
  WalkState coarse = walk_from(level_camera());
  const WalkKeys keys{.forward = true, .right = true, .run = true};
  for (int i = 0; i < 1000; ++i) smooth.advance(keys, 0.001);
  coarse.advance(keys, 1.0);
  EXPECT_LT((smooth.camera().position - coarse.camera().position).norm(), 1e-12);
}

/// v(t) = V (1 - exp(-t/tau)) covers V (t - tau) once t >> tau: 1.5 m/s for 2 s with tau = 0.08 s
/// is 2.88 m.
TEST(WalkState, WalkingCoversSpeedTimesTimeLessTheStart) {
  WalkState walk = walk_from(level_camera());
  walk.advance({.forward = true}, 2.0);
  EXPECT_NEAR(walk.camera().position.z(), -1.5 * (2.0 - 0.08), 1e-9);
  EXPECT_DOUBLE_EQ(walk.camera().position.x(), 1.0);
}

TEST(WalkState, ForwardIsLevelWhateverThePitch) {
  WalkState walk = walk_from(level_camera());
  walk.look(30 * degree, -50 * degree);
  const Eigen::Vector3d start = walk.camera().position;
  walk.advance({.forward = true}, 1.0);
  const Eigen::Vector3d way = walk.camera().position - start;
  EXPECT_NEAR(way.y(), 0.0, 1e-12);
  EXPECT_NEAR(way.norm(), 1.5 * (1.0 - 0.08), 1e-5);
}

/// The picture's right is direction x up.
TEST(WalkState, RightIsThePicturesRight) {
  WalkState walk = walk_from(level_camera());
  walk.advance({.right = true}, 1.0);
  const Camera camera = level_camera();
  const Eigen::Vector3d right = camera.direction.cross(camera.up);
  EXPECT_GT((walk.camera().position - camera.position).dot(right), 1.0);
}

TEST(WalkState, UpIsTheWorldsUp) {
  WalkState walk = walk_from(level_camera());
  walk.look(0.0, -60 * degree);
  walk.advance({.up = true}, 1.0);
  EXPECT_GT(walk.camera().position.y(), 2.6);
  EXPECT_NEAR(walk.camera().position.z(), 0.0, 1e-12);
}

TEST(WalkState, TurningTurnsTheEyeTheWayItSays) {
  WalkState walk = walk_from(level_camera());
  walk.look(90 * degree, 0.0);
  EXPECT_LT((walk.camera().direction - Eigen::Vector3d(1, 0, 0)).norm(), 1e-12);
  walk.look(0.0, 30 * degree);
  EXPECT_NEAR(walk.camera().direction.y(), 0.5, 1e-12);
  WalkState other = walk_from(level_camera());
  other.advance({.turn_left = true}, 0.5);
  EXPECT_LT(other.camera().direction.x(), -0.1);
}

TEST(WalkState, TheEyeStopsFiveDegreesFromZenithAndNadir) {
  WalkState walk = walk_from(level_camera());
  walk.look(0.0, 400 * degree);
  EXPECT_NEAR(walk.camera().direction.y(), std::cos(5 * degree), 1e-12);
  walk.look(0.0, -400 * degree);
  EXPECT_NEAR(walk.camera().direction.y(), -std::cos(5 * degree), 1e-12);
}

/// Each turn has rounding errors; the frame is orthonormalised every time, so errors do not add up.
TEST(WalkState, TheCameraStaysAFrameAfterManyTurns) {
  WalkState walk = walk_from(level_camera());
  for (int i = 0; i < 20000; ++i) walk.look(0.01, 0.003 * std::sin(0.02 * i));
  const Camera& camera = walk.camera();
  EXPECT_NEAR(camera.direction.norm(), 1.0, 1e-14);
  EXPECT_NEAR(camera.up.norm(), 1.0, 1e-14);
  EXPECT_NEAR(camera.direction.dot(camera.up), 0.0, 1e-14);
  // The camera is not rolled: the horizon is level.
  EXPECT_NEAR(camera.direction.cross(camera.up).y(), 0.0, 1e-9);
}

TEST(WalkState, ComesToRestAndSaysSo) {
  WalkState walk = walk_from(level_camera());
  EXPECT_FALSE(walk.advance({}, 0.02));
  EXPECT_TRUE(walk.advance({.forward = true}, 0.5));
  int steps = 0;
  while (walk.advance({}, 0.02)) ASSERT_LT(++steps, 100);
  // A thousandth of the speed is reached after tau ln 1000 = 0.55 s.
  EXPECT_NEAR(steps * 0.02, 0.08 * std::log(1000.0), 0.03);
  const Eigen::Vector3d rest = walk.camera().position;
  walk.advance({}, 1.0);
  EXPECT_EQ(walk.camera().position, rest);
}

TEST(WalkState, ACameraLookingStraightDownCanStillWalkAndTurn) {
  Camera plan = level_camera();
  plan.direction = {0, -1, 0};
  plan.up = {0, 0, -1};
  WalkState walk = walk_from(plan);
  walk.advance({.forward = true}, 1.0);
  EXPECT_LT(walk.camera().position.z(), -1.0);
  walk.look(0.0, 45 * degree);
  EXPECT_NEAR(walk.camera().direction.z(), -std::sin(45 * degree), 1e-12);
}

}  // namespace
}  // namespace lightwell::walk_state_test
