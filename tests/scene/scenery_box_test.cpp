#include "scene/scenery_box.h"

#include <gtest/gtest.h>

namespace lightwell::scenery_box_test {
namespace {

using Eigen::AlignedBox3d;
using Eigen::Vector3d;

// The six sides of a box.
std::vector<AlignedBox3d> sides(const Vector3d& low, const Vector3d& high) {
  std::vector<AlignedBox3d> sides;
  for (int axis = 0; axis < 3; ++axis) {
    for (const bool is_high : {false, true}) {
      AlignedBox3d side(low, high);
      side.min()[axis] = side.max()[axis] = is_high ? high[axis] : low[axis];
      sides.push_back(side);
    }
  }
  return sides;
}

const AlignedBox3d room(Vector3d(0, 0, 0), Vector3d(5, 4, 3));  // 7 m long

AlignedBox3d ground(double half) {
  return {Vector3d(-half, -half, 0), Vector3d(half, half, 0)};
}

TEST(SceneryBox, IsThatOfAllWithoutABackdrop) {
  std::vector<AlignedBox3d> boxes = sides(room.min(), room.max());
  EXPECT_TRUE(scenery_box(boxes).isApprox(room));
  boxes.push_back(ground(60.0));
  EXPECT_EQ(scenery_box(boxes).max().x(), 60.0);
  EXPECT_TRUE(scenery_box(std::vector<AlignedBox3d>{ground(60.0)}).isApprox(ground(60.0)));
  EXPECT_TRUE(scenery_box(std::vector<AlignedBox3d>()).isEmpty());
}

TEST(SceneryBox, LeavesOutAGroundAndTheSmallFacetsOfADome) {
  std::vector<AlignedBox3d> boxes = {ground(3000.0)};
  for (const AlignedBox3d& side : sides(room.min(), room.max())) boxes.push_back(side);
  EXPECT_TRUE(scenery_box(boxes).isApprox(room));
  for (const Vector3d& at : {Vector3d(3000, 0, 0), Vector3d(0, -3000, 0), Vector3d(0, 0, 3000)}) {
    boxes.emplace_back(at, at + Vector3d(10, 10, 10));
  }
  EXPECT_TRUE(scenery_box(boxes).isApprox(room));
}

// Houses all over a town are scenery, however small each is.
TEST(SceneryBox, HoldsThingsThatLieScattered) {
  std::vector<AlignedBox3d> boxes = {ground(3000.0)};
  for (int i = 0; i < 30; ++i) {
    const Vector3d at(200.0 * i - 3000.0, 150.0 * i - 2000.0, 0.0);
    for (const AlignedBox3d& side : sides(at, at + room.max())) boxes.push_back(side);
  }
  EXPECT_EQ(scenery_box(boxes).max().x(), 3000.0);
}

}  // namespace
}  // namespace lightwell::scenery_box_test
