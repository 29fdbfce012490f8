#include "mesh/geometry/triangulate.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "mesh/facets/group_patches.h"
#include "mesh/facets/pair_triangles.h"
#include "scene/sampling.h"

namespace lightwell::triangulate_test {
namespace {

using Eigen::Vector2d;

double twice_area(const PlanarTriangulation& t, int i) {
  const auto& [a, b, c] = t.triangles[i];
  const Vector2d u = t.points[b] - t.points[a], v = t.points[c] - t.points[a];
  return u.x() * v.y() - u.y() * v.x();
}

TEST(Triangulate, CoversTheHullAndKeepsItsConstraints) {
  std::vector<Vector2d> points{{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  for (std::uint64_t i = 0; i < 200; ++i) {
    points.emplace_back(0.01 + 0.98 * random_uniform(random_key(i, 1)),
                        0.01 + 0.98 * random_uniform(random_key(i, 2)));
  }
  const auto t = triangulate(points, {{0, 1}, {1, 2}, {2, 3}, {3, 0}, {0, 2}});
  EXPECT_TRUE(t.is_as_given);
  // Euler: 2 n - 2 - hull triangles over n points.
  EXPECT_EQ(t.triangles.size(), 2 * points.size() - 2 - 4);
  double area = 0.0;
  int constrained = 0;
  for (std::size_t i = 0; i < t.triangles.size(); ++i) {
    EXPECT_GT(twice_area(t, static_cast<int>(i)), 0.0);
    area += 0.5 * twice_area(t, static_cast<int>(i));
    for (int c = 0; c < 3; ++c) {
      constrained += t.constrained[i][c] ? 1 : 0;
      const int n = t.neighbor[i][c];
      if (n < 0) continue;
      EXPECT_NE(std::find(t.neighbor[n].begin(), t.neighbor[n].end(), static_cast<int>(i)),
                t.neighbor[n].end());
    }
  }
  EXPECT_NEAR(area, 1.0, 1e-12);
  EXPECT_EQ(constrained, 4 + 2);  // hull edges from one side, the diagonal from both
}

TEST(Triangulate, CrossingConstraintsMeetInAPointOfTheirOwn) {
  const auto t = triangulate({{0, 0}, {1, 0}, {1, 1}, {0, 1}}, {{0, 2}, {1, 3}});
  EXPECT_FALSE(t.is_as_given);
  ASSERT_EQ(t.points.size(), 5u);
  EXPECT_NEAR((t.points[4] - Vector2d(0.5, 0.5)).norm(), 0.0, 1e-15);
  EXPECT_EQ(t.triangles.size(), 4u);
}

TEST(PairTriangles, SquaresCutAlongTheirDiagonalsBecomeSquaresAgain) {
  std::vector<Vector2d> points;
  const int n = 6;
  for (int j = 0; j <= n; ++j) {
    for (int i = 0; i <= n; ++i) points.emplace_back(i, j);
  }
  const auto t = triangulate(points, {});
  const std::vector<int> partner = pair_triangles(t.points, t.triangles, t.neighbor);
  for (std::size_t i = 0; i < partner.size(); ++i) {
    ASSERT_GE(partner[i], 0);
    EXPECT_EQ(partner[partner[i]], static_cast<int>(i));
    Eigen::AlignedBox2d box;
    for (int v : t.triangles[i]) box.extend(t.points[v]);
    for (int v : t.triangles[partner[i]]) box.extend(t.points[v]);
    EXPECT_EQ(box.volume(), 1.0);
  }
}

TEST(PairTriangles, FlatPairsStayTriangles) {
  // Two needles: their quadrilateral would have angles of 12 and 168 degrees.
  const std::vector<Vector2d> points{{0, 0}, {1, 0}, {1, 0.2}, {2, 0.2}};
  const std::vector<std::array<int, 3>> triangles{{0, 1, 2}, {1, 3, 2}};
  const auto partner = pair_triangles(points, triangles, {{1, -1, -1}, {-1, 0, -1}});
  EXPECT_EQ(partner, (std::vector<int>{-1, -1}));
}

TEST(Triangulate, OfPointsOnOneCircleTheLowestIsJoinedWithAll) {
  // Points on a circle with exact coordinates (5^2 = 3^2 + 4^2), in arbitrary order.
  const std::vector<Vector2d> circle{{3, 4},  {-5, 0}, {4, 3}, {0, -5},  {-3, 4}, {5, 0},
                                     {4, -3}, {-4, 3}, {0, 5}, {-4, -3}, {3, -4}, {-3, -4}};
  const auto fan = triangulate(circle, {});
  ASSERT_EQ(fan.triangles.size(), circle.size() - 2);
  for (std::size_t t = 0; t < fan.triangles.size(); ++t) {
    EXPECT_EQ(fan.triangles[t][0], 0);
    EXPECT_GT(twice_area(fan, static_cast<int>(t)), 0.0);
    EXPECT_TRUE(t == 0 || fan.triangles[t - 1] < fan.triangles[t]);
    for (int i = 0; i < 3; ++i) {
      const int n = fan.neighbor[t][i];
      if (n < 0) continue;
      const auto& around = fan.neighbor[n];
      EXPECT_EQ(std::count(around.begin(), around.end(), static_cast<int>(t)), 1);
    }
  }
  // A constraint stays even if it does not end in the lowest point.
  const auto split = triangulate(circle, {{5, 1}});
  int fixed = 0;
  for (const auto& edges : split.constrained) fixed += edges[0] + edges[1] + edges[2];
  EXPECT_EQ(fixed, 2);
}

PlacedElement element(int cell, double x, double width) {
  return {.cell = cell, .area = width, .box = {Vector2d(x, 0), Vector2d(x + width, 1)}};
}

TEST(GroupPatches, LeftoversJoinTheirNeighbourAndPartsStayApart) {
  // A strip of unit cells 0, 1, 2 with a leftover of 0.1 at the end. No contact crosses a line
  // inside cell 1.
  const std::vector<PlacedElement> elements{element(0, 0, 1), element(1, 1, 0.4),
                                            element(1, 1.4, 0.6), element(2, 2, 0.1)};
  const auto patch = group_patches(elements, {{0, 1, 1.0}, {2, 3, 1.0}});
  EXPECT_EQ(patch, (std::vector<int>{0, 1, 2, 2}));
  // The leftover stays if the two together would be wider than 1.5 cells.
  const std::vector<PlacedElement> wide{element(0, 0, 1.45), element(1, 1.45, 0.1)};
  EXPECT_EQ(group_patches(wide, {{0, 1, 1.0}}), (std::vector<int>{0, 1}));
}

}  // namespace
}  // namespace lightwell::triangulate_test
