#include "scene/scenery_box.h"

#include <gtest/gtest.h>

#include <algorithm>

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

// Triangles of 100 m are each twice as long as a room, and all of them 16 times as long. A ground
// of 40 m is not: its patches are no longer than the room's walls. Sizes of patches follow this
// part, the exactness of coordinates does not.
TEST(SceneryBox, IsSmallerForSizesOfPatches) {
  std::vector<AlignedBox3d> boxes = sides(room.min(), room.max());
  EXPECT_EQ(are_near(boxes), std::vector<char>(6, 1));
  boxes.push_back(ground(20.0));
  EXPECT_EQ(are_near(boxes), std::vector<char>(7, 1));
  boxes.back() = ground(150.0);
  EXPECT_EQ(are_near(boxes), (std::vector<char>{1, 1, 1, 1, 1, 1, 0}));
  EXPECT_EQ(scenery_box(boxes).max().x(), 150.0);
  boxes.pop_back();
  for (int i = -4; i < 4; ++i) {
    const Vector3d at(100.0 * i, 0.0, -1.0);
    boxes.emplace_back(at, at + Vector3d(100, 100, 0));
  }
  std::vector<char> expected(14, 0);
  std::fill_n(expected.begin(), 6, 1);
  EXPECT_EQ(are_near(boxes), expected);
}

// A room of 7 m far from the origin: coordinates round by shares of their own size, but no more
// than the ground's of 6 km, whose middle is the origin, do.
TEST(SceneryBox, RoundingGrowsWithTheDistanceFromTheOrigin) {
  const auto scene_at = [](double x) {
    Scene scene;
    for (const AlignedBox3d& side : sides(room.min(), room.max())) {
      PolygonMesh mesh;
      for (const int corner : {0, 1, 3, 2}) {
        Vector3d at = side.corner(static_cast<AlignedBox3d::CornerType>(corner));
        if (side.sizes().z() > 0.0 && corner / 2 == 1) at.z() = side.max().z();
        mesh.vertices.push_back(at + Vector3d(x, 0, 0));
      }
      mesh.facets.push_back({.boundary = {0, 1, 2, 3}});
      scene.surfaces.push_back({.shape = mesh});
    }
    PolygonMesh land{
        .vertices = {{-3000, -3000, 0}, {3000, -3000, 0}, {3000, 3000, 0}, {-3000, 3000, 0}},
        .facets = {{.boundary = {0, 1, 2, 3}}}};
    scene.surfaces.push_back({.shape = land});
    return scene;
  };
  // Coordinates and lengths of 2 km are multiples of 2^-42 m; four operations round by half of
  // that.
  constexpr double rounding = 4.0 * 0x1p-43;
  EXPECT_NEAR(scenery_length(scene_at(2000.0)), room.diagonal().norm(), rounding);
  EXPECT_NEAR(coordinate_length(scene_at(0.0)), room.diagonal().norm(), rounding);
  EXPECT_NEAR(coordinate_length(scene_at(2000.0)), Vector3d(2005, 4, 3).norm(), rounding);
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
