#include "raytrace/readings/isolux_lines.h"

#include <gtest/gtest.h>

#include <cmath>

namespace lightwell::isolux_lines_test {
namespace {

// A grid of `columns` x `rows` points, 1 m apart.
LuxGrid grid_of(int columns, int rows) {
  LuxGrid grid;
  grid.columns = columns;
  grid.rows = rows;
  grid.step_u = grid.step_v = 1.0;
  for (int i = 0; i < columns * rows; ++i) grid.cell.push_back(i);
  return grid;
}

template <class Light>
Eigen::ArrayXd values_of(const LuxGrid& grid, Light&& light) {
  Eigen::ArrayXd lux(static_cast<Eigen::Index>(grid.cell.size()));
  for (std::size_t i = 0; i < grid.cell.size(); ++i) {
    lux[static_cast<Eigen::Index>(i)] =
        light(grid.cell[i] % grid.columns + 0.5, grid.cell[i] / grid.columns + 0.5);
  }
  return lux;
}

// Places are up to 6 m, and a place is the result of ten operations on doubles, each rounded by
// 1.1e-16 of at most 6: 7e-15, here with a factor 10 for cancellation of differences.
constexpr double rounding = 1e-13;

TEST(IsoluxLines, OfAnEvenSlopeIsOneStraightLine) {
  const LuxGrid grid = grid_of(6, 4);
  const Eigen::ArrayXd lux =
      values_of(grid, [](double x, double y) { return 100.0 * x + 20.0 * y; });
  const std::vector<Isoline> lines = isolux_lines(grid, lux, 300.0);
  ASSERT_EQ(lines.size(), 1u);
  EXPECT_FALSE(lines[0].is_closed);
  for (const Eigen::Vector2d& p : lines[0].points) {
    // The slope of 100 lx/m turns an error of the place into one of light.
    EXPECT_NEAR(100.0 * p.x() + 20.0 * p.y(), 300.0, 100.0 * rounding);
  }
  // The line goes from the lowest row of points to the highest.
  const double ends[2] = {lines[0].points.front().y(), lines[0].points.back().y()};
  EXPECT_NEAR(std::min(ends[0], ends[1]), 0.5, rounding);
  EXPECT_NEAR(std::max(ends[0], ends[1]), 3.5, rounding);
}

TEST(IsoluxLines, AroundAPeakIsClosed) {
  const LuxGrid grid = grid_of(9, 9);
  const auto cone = [](double x, double y) { return 10.0 - std::hypot(x - 4.5, y - 4.5); };
  const std::vector<Isoline> lines = isolux_lines(grid, values_of(grid, cone), 7.5);
  ASSERT_EQ(lines.size(), 1u);
  EXPECT_TRUE(lines[0].is_closed);
  for (const Eigen::Vector2d& p : lines[0].points) {
    // Along an edge of 1 m the distance from the peak bends at most by 1 / (8 r), r = 2 m here.
    EXPECT_NEAR((p - Eigen::Vector2d(4.5, 4.5)).norm(), 2.5, 1.0 / 16.0);
  }
}

TEST(IsoluxLines, OfASaddleNeverCross) {
  const LuxGrid grid = grid_of(2, 2);
  Eigen::ArrayXd lux(4);
  lux << 2, 0, 0, 1;  // the mean, 0.75, is above the value: the bright corners are joined
  EXPECT_EQ(isolux_lines(grid, lux, 0.5).size(), 2u);
  for (const Isoline& line : isolux_lines(grid, lux, 0.5)) {
    // Both ends lie on edges of one dark corner, (1.5, 0.5) or (0.5, 1.5).
    const bool is_right = line.points[0].x() + line.points[1].x() > 2.0;
    const Eigen::Vector2d dark = is_right ? Eigen::Vector2d(1.5, 0.5) : Eigen::Vector2d(0.5, 1.5);
    for (const Eigen::Vector2d& p : line.points) EXPECT_LE((p - dark).norm(), 1.0);
  }
}

TEST(IsoluxLines, HaveAGapWhereAPointIsMissing) {
  LuxGrid grid = grid_of(6, 4);
  grid.cell.erase(grid.cell.begin() + 8);  // column 2, row 1
  const Eigen::ArrayXd lux = values_of(grid, [](double x, double) { return 100.0 * x; });
  const std::vector<Isoline> lines = isolux_lines(grid, lux, 220.0);
  ASSERT_EQ(lines.size(), 1u) << "the line above the missing point";
  for (const Eigen::Vector2d& p : lines[0].points) EXPECT_GE(p.y(), 2.5);
}

TEST(IsoluxValues, AreThoseOfTheStandardOrRoundSteps) {
  EXPECT_EQ(isolux_values(180, 620), (std::vector<double>{200, 300, 500}));
  EXPECT_EQ(isolux_values(428, 735), (std::vector<double>{500, 600, 700}));
  EXPECT_EQ(isolux_values(5, 3000).size(), 8u);
  EXPECT_EQ(isolux_values(5, 3000).back(), 2000.0);
  EXPECT_TRUE(isolux_values(10, 10).empty());
}

}  // namespace
}  // namespace lightwell::isolux_lines_test
