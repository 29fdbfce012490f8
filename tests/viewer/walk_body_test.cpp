#include "viewer/walk_body.h"

#include <gtest/gtest.h>

#include <cmath>

#include "solved_box.h"

namespace lightwell {
namespace {

constexpr double frame = 1.0 / 60.0;

/// A hall with its floor at z = 0, z up: a wall at x = 4 that faces -x; steps of 0.2 m at y > 2 and
/// y > 2.5; a ledge of 0.5 m at x < -3; a hole in the floor at y < -4.
SolvedScene hall() {
  SolvedQuads quads;
  const auto level = [&](double x0, double x1, double y0, double y1, double z) {
    quads.add({{{x0, y0, z}, {x1, y0, z}, {x1, y1, z}, {x0, y1, z}}}, grey);
  };
  level(-3, 6, -4, 2, 0.0);
  level(-3, 6, 2, 2.5, 0.2);
  level(-3, 6, 2.5, 9, 0.4);
  level(-6, -3, -4, 9, 0.5);
  level(-6, 6, -9, -4, -2.0);
  quads.add({{{4, -9, -2}, {4, -9, 5}, {4, 9, 5}, {4, 9, -2}}}, white);        // faces -x
  quads.add({{{-3, -4, 0}, {-3, 9, 0}, {-3, 9, 0.5}, {-3, -4, 0.5}}}, white);  // faces +x
  quads.add({{{-3, 2, 0}, {6, 2, 0}, {6, 2, 0.2}, {-3, 2, 0.2}}}, white);      // faces -y
  quads.add({{{-3, 2.5, 0.2}, {6, 2.5, 0.2}, {6, 2.5, 0.4}, {-3, 2.5, 0.4}}}, white);
  return quads.solved();
}

class WalkBodyTest : public testing::Test {
 protected:
  SolvedScene hall_ = hall();
  ElementCaster caster_{hall_.mesh};
  std::vector<ElementKind> kinds_ = element_kinds(hall_, {});
  Obstacles obstacles_{caster_, kinds_};
  WalkPhysics person_{WalkBody{}, Eigen::Vector3d::UnitZ()};

  Eigen::Vector3d walk(Eigen::Vector3d eye, const Eigen::Vector3d& velocity, double seconds) {
    for (double t = 0.0; t < seconds; t += frame) {
      eye = person_.move(obstacles_, eye, frame * velocity);
      eye = person_.settle(obstacles_, eye, frame);
    }
    return eye;
  }
};

TEST(WalkBody, IsAPersonInARoomAndADollInAModel) {
  const auto in = [](const Eigen::Vector3d& size, double eye_height = 0.0) {
    return walk_body({Eigen::Vector3d::Zero(), size}, Eigen::Vector3d::UnitZ(), eye_height);
  };
  EXPECT_DOUBLE_EQ(in({4, 3, 2.5}).eye_height, 1.6);
  EXPECT_DOUBLE_EQ(in({4, 3, 2.5}).radius, 0.25);
  EXPECT_DOUBLE_EQ(in({40, 30, 0}).eye_height, 1.6) << "a flat field";
  EXPECT_DOUBLE_EQ(in({0.5, 0.5, 0.5}).eye_height, 0.32);
  EXPECT_DOUBLE_EQ(in({0.5, 0.5, 0.5}).step, 0.06);
  EXPECT_DOUBLE_EQ(in({0.5, 0.5, 0.5}, 0.4).eye_height, 0.4);
  EXPECT_DOUBLE_EQ(in({0.5, 0.5, 0.5}, 0.4).radius, 0.0625);
}

TEST_F(WalkBodyTest, StopsARadiusBeforeAWall) {
  const Eigen::Vector3d eye = walk({0, 0, 1.6}, {1.4, 0, 0}, 5.0);
  EXPECT_NEAR(eye.x(), 3.75, 2e-3) << "a thousandth of the radius counts as touching";
  EXPECT_NEAR(eye.z(), 1.6, 1e-3);
}

/// Along the wall it keeps the part of the way that the wall does not stop.
TEST_F(WalkBodyTest, SlidesAlongAWall) {
  const Eigen::Vector3d eye = walk({3.7, -3, 1.6}, {1.0, 1.0, 0}, 4.0);
  EXPECT_NEAR(eye.x(), 3.75, 2e-3);
  EXPECT_NEAR(eye.y(), 1.0, 0.05);
}

TEST_F(WalkBodyTest, IsNotShotThroughAWallByALongFrame) {
  EXPECT_LT(person_.move(obstacles_, {0, 0, 1.6}, {10, 0, 0}).x(), 3.76);
}

TEST_F(WalkBodyTest, ClimbsStepsAndComesDownAgain) {
  Eigen::Vector3d eye = walk({0, 0, 1.6}, {0, 1.4, 0}, 3.0);
  EXPECT_NEAR(eye.y(), 4.2, 0.1);
  EXPECT_NEAR(eye.z(), 2.0, 0.01);
  eye = walk(eye, {0, -1.4, 0}, 3.0);
  EXPECT_NEAR(eye.z(), 1.6, 0.01);
  EXPECT_TRUE(person_.is_on_ground());
}

TEST_F(WalkBodyTest, DoesNotClimbALedgeButJumpsOntoIt) {
  Eigen::Vector3d eye = walk({-2, 0, 1.6}, {-1.4, 0, 0}, 2.0);
  EXPECT_NEAR(eye.x(), -2.75, 2e-3);
  person_.jump();
  EXPECT_FALSE(person_.is_on_ground());
  eye = walk(eye, {-1.4, 0, 0}, 1.0);
  EXPECT_NEAR(eye.z(), 2.1, 0.01) << "a jump of 0.45 m and a step of 0.3 m reach 0.5 m";
}

/// A jump rises by its height and takes 2 sqrt(2 h / g); with steps of 1/120 s times and heights
/// are those of the trapezoidal rule, exact for a constant g but for the last moment.
TEST_F(WalkBodyTest, JumpsByTheLawOfFall) {
  Eigen::Vector3d eye = walk({0, 0, 1.6}, {0, 0, 0}, 0.1);
  person_.jump();
  double highest = 0.0, seconds = 0.0;
  while (!person_.is_on_ground() && seconds < 2.0) {
    eye = person_.settle(obstacles_, eye, frame);
    highest = std::max(highest, eye.z() - 1.6);
    seconds += frame;
  }
  EXPECT_NEAR(highest, 0.45, 0.005);
  EXPECT_NEAR(seconds, 2.0 * std::sqrt(2.0 * 0.45 / 9.81), 2.0 * frame);
}

TEST_F(WalkBodyTest, FallsToTheGroundAndStaysThere) {
  const Eigen::Vector3d eye = walk({0, -3, 1.6}, {0, -1.4, 0}, 3.0);
  EXPECT_LT(eye.y(), -4.0);
  EXPECT_NEAR(eye.z(), -0.4, 0.01) << "two metres down";
}

TEST_F(WalkBodyTest, KeepsItsHeightWhereThereIsNoGround) {
  const Eigen::Vector3d eye = walk({50, 0, 3.0}, {1, 0, 0}, 1.0);
  EXPECT_EQ(eye.z(), 3.0);
}

/// From behind the wall is not drawn, and stops nobody.
TEST_F(WalkBodyTest, WalksThroughBacksThatAreNotSeen) {
  EXPECT_LT(walk({5.5, 0, 1.6}, {-1.4, 0, 0}, 2.0).x(), 3.75);
}

}  // namespace
}  // namespace lightwell
