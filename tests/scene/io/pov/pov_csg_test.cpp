#include "scene/io/pov/pov_csg.h"

#include <gtest/gtest.h>

#include "scene/io/convex_cut.h"
#include "scene/io/placed_mesh.h"

namespace lightwell::pov_csg_test {
namespace {

using Eigen::Vector3d;

PovConvex box(const Vector3d& low, const Vector3d& high) {
  std::vector<Loop> faces = cube_loops();
  for (Loop& face : faces) {
    for (Vector3d& p : face) p = (p.array() < 0.0).select(low.array(), high.array());
  }
  return pov_convex(std::move(faces));
}

double area(const std::vector<PovCutFace>& faces) {
  double sum = 0.0;
  for (const PovCutFace& face : faces) sum += area_vector(face.loop).norm();
  return sum;
}

/// Volume behind the faces (divergence theorem): a third of the sum of n . p over their areas.
double volume(const std::vector<PovCutFace>& faces) {
  double sum = 0.0;
  for (const PovCutFace& face : faces) sum += area_vector(face.loop).dot(face.loop.front()) / 3.0;
  return sum;
}

// Sums of some ten products of numbers of a few bits: roundings of 2^-53 each.
constexpr double rounding = 1e-13;

TEST(PovCsg, ANicheOpensAWall) {
  const PovConvex wall = box({0, 0, 0}, {4, 3, 1});
  const PovConvex niche = box({1, 1, -1}, {2, 2, 0.5});
  const auto faces = pov_difference(wall, {niche}, 5.0);
  EXPECT_NEAR(volume(faces), 12.0 - 0.5, rounding);
  // A hole of 1 m2 in front, a back wall of 1 m2 and four sides of 0.5 m2.
  EXPECT_NEAR(area(faces), 2.0 * (12.0 + 4.0 + 3.0) + 4.0 * 0.5, rounding);
}

TEST(PovCsg, ARoomIsABoxInABox) {
  const auto faces = pov_difference(box({-1, -1, -1}, {5, 4, 3}), {box({0, 0, 0}, {4, 3, 2})}, 9.0);
  EXPECT_NEAR(volume(faces), 6.0 * 5.0 * 4.0 - 24.0, rounding);
  EXPECT_EQ(faces.size(), 12u);
}

// Holes side by side share a border that no face may close, and holes that overlap count once.
TEST(PovCsg, BodiesThatTouchOrOverlapAreOne) {
  const PovConvex block = box({0, 0, 0}, {4, 2, 2});
  const auto touching =
      pov_difference(block, {box({1, 1, -1}, {2, 3, 3}), box({2, 1, -1}, {3, 3, 3})}, 5.0);
  EXPECT_NEAR(volume(touching), 16.0 - 4.0, rounding);
  EXPECT_NEAR(area(touching), area(pov_difference(block, {box({1, 1, -1}, {3, 3, 3})}, 5.0)),
              rounding);
  const auto overlapping =
      pov_difference(block, {box({1, 1, -1}, {2.5, 3, 3}), box({1.5, 1, -1}, {3, 3, 3})}, 5.0);
  EXPECT_NEAR(area(overlapping), area(touching), rounding);
  EXPECT_NEAR(volume(overlapping), 12.0, rounding);
}

TEST(PovCsg, FlushBodiesOpenAndNeighboursDoNot) {
  const PovConvex block = box({0, 0, 0}, {2, 2, 2});
  const auto flush = pov_difference(block, {box({0.5, 1, 0.5}, {1.5, 2, 1.5})}, 3.0);
  EXPECT_NEAR(volume(flush), 7.0, rounding);
  EXPECT_NEAR(area(flush), 24.0 + 4.0, rounding);
  const auto beside = pov_difference(block, {box({2, 0, 0}, {3, 2, 2})}, 3.0);
  EXPECT_NEAR(area(beside), 24.0, rounding);
  EXPECT_NEAR(volume(beside), 8.0, rounding);
}

TEST(PovCsg, AnIntersectionIsWhatIsInAll) {
  const std::vector<PovConvex> bodies = {box({0, 0, 0}, {2, 2, 2}), box({1, 0, 0}, {3, 2, 1})};
  const auto faces = pov_intersection(bodies, 4.0);
  EXPECT_NEAR(volume(faces), 2.0, rounding);
  EXPECT_NEAR(area(faces), 2.0 * (2.0 + 1.0 + 2.0), rounding);
}

TEST(PovCsg, BodiesThatAreNotConvexAreRefused) {
  std::vector<Loop> faces = cube_loops();
  for (Loop& face : faces) {
    for (Vector3d& p : face) {
      if (p == Vector3d(1, 1, 1)) p = Vector3d(-0.5, -0.5, -0.5);
    }
  }
  EXPECT_TRUE(pov_convex(std::move(faces)).planes.empty());
}

}  // namespace
}  // namespace lightwell::pov_csg_test
