#include "viewer/export/chart_plane.h"

#include <gtest/gtest.h>

#include <cmath>

namespace lightwell::chart_plane_test {
namespace {

using Eigen::Vector2d;

TEST(ChartPlane, TheBoxOfATurnedRectangleLiesAlongIt) {
  const Vector2d x(std::cos(0.3), std::sin(0.3)), y(-x.y(), x.x());
  std::vector<Vector2d> points;
  for (int i = 0; i <= 10; ++i) {
    for (int j = 0; j <= 4; ++j) points.push_back(0.3 * i * x + 0.2 * j * y);
  }
  const Vector2d found = box_direction(points);
  // Sums of a few products have errors of some 2^-52.
  EXPECT_NEAR(std::abs(found.dot(x)), 1.0, 1e-14);
}

/// Two unit squares side by side whose common edge has vertices of its own on either side.
struct TornSquares {
  double gap = 0.0;
  std::vector<Vector2d> places = {{0, 0},       {1, 0},       {1, 1},       {0, 1},
                                  {1 + gap, 0}, {2 + gap, 0}, {2 + gap, 1}, {1 + gap, 1}};
  std::vector<std::array<int, 4>> faces = {{0, 1, 2, 3}, {4, 5, 6, 7}};
};

TEST(ChartPlane, ASeamIsCutAlongItself) {
  const TornSquares torn;
  const auto lines = narrow_gaps(torn.faces, torn.places, 0.01);
  ASSERT_FALSE(lines.empty());
  EXPECT_NEAR(lines[0].point.x(), 1.0, 1e-15);
  EXPECT_NEAR(std::abs(lines[0].normal.x()), 1.0, 1e-15);
}

TEST(ChartPlane, AThinWallIsCutInItsMiddleAndAThickOneIsNot) {
  const TornSquares thin{.gap = 0.02};
  const auto lines = narrow_gaps(thin.faces, thin.places, 0.05);
  ASSERT_FALSE(lines.empty());
  EXPECT_NEAR(lines[0].point.x(), 1.01, 1e-15);
  const TornSquares thick{.gap = 0.06};
  EXPECT_TRUE(narrow_gaps(thick.faces, thick.places, 0.05).empty());
}

/// Squares that share vertices have no border between them, and neither have the two sides of a
/// needle, which face away from each other.
TEST(ChartPlane, WholeFacesAndSharpTipsAreNotCut) {
  const std::vector<Vector2d> places = {{0, 0}, {1, 0}, {1, 1}, {0, 1}, {2, 0}, {2, 1}};
  const std::vector<std::array<int, 4>> whole = {{0, 1, 2, 3}, {1, 4, 5, 2}};
  EXPECT_TRUE(narrow_gaps(whole, places, 0.1).empty());
  EXPECT_EQ(border_edges(whole, places).size(), 6u);
  const std::vector<Vector2d> needle = {{0, 0}, {10, 0}, {0, 0.02}};
  const std::vector<std::array<int, 4>> one = {{0, 1, 2, -1}};
  EXPECT_TRUE(narrow_gaps(one, needle, 0.1).empty());
}

}  // namespace
}  // namespace lightwell::chart_plane_test
