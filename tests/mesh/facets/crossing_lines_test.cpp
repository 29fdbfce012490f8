#include "mesh/facets/crossing_lines.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "mesh/geometry/cross.h"

namespace lightwell::crossing_lines_test {
namespace {

using Eigen::Vector2d;

struct Lines {
  std::vector<Vector2d> points{};
  std::vector<std::array<int, 2>> pairs{};
};

// A square of side 1 whose centre `count` lines cross in directions that have no short numbers, so
// that rounding sets their common point apart.
Lines star_in_square(int count) {
  Lines star{.points = {{0, 0}, {1, 0}, {1, 1}, {0, 1}}, .pairs = {{0, 1}, {1, 2}, {2, 3}, {0, 3}}};
  const Vector2d center(0.5, 0.5);
  for (int i = 0; i < count; ++i) {
    const double angle = std::numbers::pi * (i + 0.3) / count;
    const Vector2d along(std::cos(angle), std::sin(angle));
    const int first = static_cast<int>(star.points.size());
    star.points.push_back(center - 0.31 * along);
    star.points.push_back(center + 0.37 * along);
    star.pairs.push_back({first, first + 1});
  }
  return star;
}

double area(const PlanarTriangulation& t, std::size_t triangle) {
  const auto& [a, b, c] = t.triangles[triangle];
  return 0.5 * cross(t.points[static_cast<std::size_t>(b)] - t.points[static_cast<std::size_t>(a)],
                     t.points[static_cast<std::size_t>(c)] - t.points[static_cast<std::size_t>(a)]);
}

int flat_triangles(const PlanarTriangulation& t, double rounding) {
  int count = 0;
  for (int i = 0; i < static_cast<int>(t.triangles.size()); ++i) {
    count += flat_corner(t, i, rounding) >= 0 ? 1 : 0;
  }
  return count;
}

// Eight roundings of coordinates up to 1, as for facets.
const double rounding = std::ldexp(8.0, -53);

TEST(CrossingLines, ThatMeetInOnePlaceMeetInOnePoint) {
  const Lines star = star_in_square(12);
  EXPECT_GT(flat_triangles(triangulate(star.points, star.pairs), rounding), 0)
      << "the lines cross in one point as they are";
  const PlanarTriangulation t = triangulate_crossing(star.points, star.pairs, rounding);
  EXPECT_EQ(flat_triangles(t, rounding), 0);
  EXPECT_FALSE(t.is_as_given);
  const auto near_center = std::ranges::count_if(
      t.points, [](const Vector2d& p) { return (p - Vector2d(0.5, 0.5)).norm() < 1e-9; });
  EXPECT_EQ(near_center, 1);
  double sum = 0.0;
  for (std::size_t i = 0; i < t.triangles.size(); ++i) sum += area(t, i);
  // Four roundings of 2^-53 for each area, none of which exceeds that of the square.
  EXPECT_NEAR(sum, 1.0, std::ldexp(4.0 * static_cast<double>(t.triangles.size()), -53));
}

TEST(CrossingLines, KeepTheGivenPointsAndTheirNumbers) {
  const Lines star = star_in_square(12);
  const PlanarTriangulation t = triangulate_crossing(star.points, star.pairs, rounding);
  ASSERT_GE(t.points.size(), star.points.size());
  for (std::size_t i = 0; i < star.points.size(); ++i) EXPECT_EQ(t.points[i], star.points[i]);
}

// A point that rounding put beside a line is on the line: no triangle stands between them.
TEST(CrossingLines, PassThroughPointsThatRoundingPutBesideThem) {
  const double beside = std::ldexp(1.0, -53);  // half a unit in the last place of 0.5
  const std::vector<Vector2d> points{
      {0, 0},     {1, 0},    {1, 1}, {0, 1}, {0, 0.5}, {1, 0.5}, {0.5, 0.5 - beside},
      {0.3, 0.1}, {0.3, 0.9}};
  const std::vector<std::array<int, 2>> lines{{0, 1}, {1, 2}, {2, 3}, {0, 3},
                                              {4, 5}, {4, 6}, {5, 6}, {7, 8}};
  EXPECT_GT(flat_triangles(triangulate(points, lines), rounding), 0)
      << "no triangle stands between the point and the line as they are";
  EXPECT_EQ(flat_triangles(triangulate_crossing(points, lines, rounding), rounding), 0);
}

TEST(CrossingLines, LeaveLinesThatCrossNowhereAsTheyAre) {
  const std::vector<Vector2d> points{{0, 0}, {1, 0}, {1, 1}, {0, 1}, {0.2, 0.3}, {0.7, 0.8}};
  const std::vector<std::array<int, 2>> lines{{0, 1}, {1, 2}, {2, 3}, {0, 3}, {4, 5}};
  const PlanarTriangulation expected = triangulate(points, lines),
                            t = triangulate_crossing(points, lines, rounding);
  EXPECT_TRUE(t.is_as_given);
  EXPECT_EQ(t.triangles, expected.triangles);
}

}  // namespace
}  // namespace lightwell::crossing_lines_test
