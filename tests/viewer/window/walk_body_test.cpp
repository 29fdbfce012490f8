#include "viewer/window/walk_body.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/viewer/solved_box.h"

namespace lightwell::walk_body_test {
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

/// Motion into a wall keeps its component along the wall.
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

/// A jump has height h and takes 2 sqrt(2 h / g). Steps of 1/120 s by the trapezoidal rule are
/// exact for constant g, except for the last step.
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

/// The back of a wall is not drawn and does not stop a walk.
TEST_F(WalkBodyTest, WalksThroughBacksThatAreNotSeen) {
  EXPECT_LT(walk({5.5, 0, 1.6}, {-1.4, 0, 0}, 2.0).x(), 3.75);
}

/// A block with sides that face outwards, in an empty hall.
SolvedScene hall_with_block(const Eigen::Vector3d& low, const Eigen::Vector3d& high) {
  SolvedQuads quads;
  quads.add({{{-9, -9, 0}, {9, -9, 0}, {9, 9, 0}, {-9, 9, 0}}}, grey);
  const double x0 = low.x(), y0 = low.y(), z0 = low.z();
  const double x1 = high.x(), y1 = high.y(), z1 = high.z();
  quads.add({{{x0, y0, z0}, {x0, y0, z1}, {x0, y1, z1}, {x0, y1, z0}}}, white);
  quads.add({{{x1, y0, z0}, {x1, y1, z0}, {x1, y1, z1}, {x1, y0, z1}}}, white);
  quads.add({{{x0, y0, z0}, {x1, y0, z0}, {x1, y0, z1}, {x0, y0, z1}}}, white);
  quads.add({{{x0, y1, z0}, {x0, y1, z1}, {x1, y1, z1}, {x1, y1, z0}}}, white);
  quads.add({{{x0, y0, z0}, {x0, y1, z0}, {x1, y1, z0}, {x1, y0, z0}}}, white);
  quads.add({{{x0, y0, z1}, {x1, y0, z1}, {x1, y1, z1}, {x0, y1, z1}}}, white);
  return quads.solved();
}

/// A straight walk of three seconds: least horizontal distance from the body's axis to the block,
/// and the final position.
struct Passage {
  double nearest = 1e300;
  Eigen::Vector3d end{};
};
Passage walk_at(const SolvedScene& solved, const Eigen::Vector3d& low, const Eigen::Vector3d& high,
                const Eigen::Vector3d& from) {
  const ElementCaster caster(solved.mesh);
  const std::vector<ElementKind> kinds = element_kinds(solved, {});
  const Obstacles obstacles{caster, kinds};
  WalkPhysics person(WalkBody{}, Eigen::Vector3d::UnitZ());
  Passage passage{.end = from};
  for (double t = 0.0; t < 3.0; t += frame) {
    passage.end = person.move(obstacles, passage.end, frame * Eigen::Vector3d(1.4, 0, 0));
    passage.end = person.settle(obstacles, passage.end, frame);
    const Eigen::Vector3d at = passage.end.cwiseMax(low).cwiseMin(high);
    passage.nearest = std::min(passage.nearest, (passage.end - at).head<2>().norm());
  }
  return passage;
}

/// From every direction a post of 4 cm keeps the body's radius as distance, except at corners
/// between two rays of the fan, which are 0.25 m / 12 apart: there by at most their distance times
/// the slope of the round body, 2 cm * tan(asin(23/24)).
TEST(WalkBody, IsStoppedByAThinPost) {
  const Eigen::Vector3d low(2, -0.02, 0), high(2.04, 0.02, 2.5);
  const SolvedScene solved = hall_with_block(low, high);
  for (int i = -24; i <= 24; ++i) {
    const double aside = 0.01 * i;
    const Passage passage = walk_at(solved, low, high, {0.5, aside, 1.6});
    EXPECT_GT(passage.nearest, 0.25 - 0.07) << "met " << aside << " m aside";
    if (std::abs(aside) <= 0.02) {
      EXPECT_LT(passage.end.x(), 2.0) << "met " << aside << " m aside";
    }
  }
}

/// A table top, 4 cm thick, lies between two of the heights at which rays are cast around the body.
TEST(WalkBody, IsStoppedByATablesTop) {
  const Eigen::Vector3d low(2, -1, 0.72), high(3, 1, 0.76);
  const SolvedScene solved = hall_with_block(low, high);
  const Passage passage = walk_at(solved, low, high, {0.5, 0.1, 1.6});
  EXPECT_NEAR(passage.end.x(), 1.75, 2e-3) << "a thousandth of the radius counts as touching";
}

}  // namespace
}  // namespace lightwell::walk_body_test
