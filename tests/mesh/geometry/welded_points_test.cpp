#include "mesh/geometry/welded_points.h"

#include <gtest/gtest.h>

namespace lightwell::welded_points_test {
namespace {

TEST(WeldedPoints, JoinsWithinTheToleranceAcrossCellBorders) {
  const double tolerance = 1e-3;
  WeldedPoints points(tolerance);
  for (int i = -50; i <= 50; ++i) {
    // Positions all over a hash cell, on both sides of zero.
    const Eigen::Vector3d p(0.01 * i + 1.37e-4 * i, 0.3, -0.2);
    const int id = points.add(p, tolerance);
    EXPECT_EQ(points.add(p + Eigen::Vector3d(0.99e-3, 0, 0), tolerance), id);
    EXPECT_EQ(points.add(p - Eigen::Vector3d(0, 0.5e-3, 0.8e-3), tolerance), id);
    EXPECT_NE(points.add(p + Eigen::Vector3d(0, 1.01e-3, 0), tolerance), id);
  }
  EXPECT_EQ(points.size(), 2 * 101);
}

TEST(WeldedPoints, TakesTheNearestAndKeepsPointsOfSmallRadiusApart) {
  WeldedPoints points(1e-3);
  const int a = points.add({0, 0, 0}, 1e-3), b = points.add({1.5e-3, 0, 0}, 1e-3);
  EXPECT_NE(a, b);
  EXPECT_EQ(points.add({0.6e-3, 0, 0}, 1e-3), a);
  EXPECT_EQ(points.add({0.9e-3, 0, 0}, 1e-3), b);
  const int c = points.add({0.7e-3, 0, 0}, 1e-6);
  EXPECT_EQ(c, 2) << "a point that reaches 1e-6 joins nothing 6e-4 away";
  EXPECT_EQ(points.add({0.7e-3, 0, 0}, 0.0), c) << "equal points are one, whatever they reach";
}

// Later points share cells with earlier ones, and have some of their own.
TEST(WeldedPoints, ForgetsPointsAsIfTheyHadNeverBeenAdded) {
  const auto place = [](int i) { return Eigen::Vector3d(0.9e-3 * (i % 7), 1.1e-3 * (i % 5), 0.0); };
  WeldedPoints points(1e-3), expected(1e-3);
  for (int i = 0; i < 9; ++i) {
    points.add(place(i), 1e-4);
    expected.add(place(i), 1e-4);
  }
  for (int i = 9; i < 35; ++i) points.add(place(i), 1e-4);
  ASSERT_GT(points.size(), expected.size());
  points.keep_first(expected.size());
  EXPECT_EQ(points.all(), expected.all());
  for (int i = 34; i >= 0; --i) {
    EXPECT_EQ(points.add(place(i), 1e-4), expected.add(place(i), 1e-4)) << i;
  }
}

}  // namespace
}  // namespace lightwell::welded_points_test
