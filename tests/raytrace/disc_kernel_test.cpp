#include "raytrace/disc_kernel.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

namespace lightwell {
namespace {

double kernel(double x, double y) {
  return std::max(0.0, 2.0 / std::numbers::pi * (1.0 - x * x - y * y));
}

// Across a line at distance h a slice of the kernel holds 8 / (3 pi) (1 - x^2)^(3/2).
double beyond_line(double h) {
  constexpr int steps = 100000;
  double sum = 0.0;
  for (int i = 0; i < steps; ++i) {
    const double x = h + (1.0 - h) * (i + 0.5) / steps;
    sum += std::pow(1.0 - x * x, 1.5);
  }
  return sum * (1.0 - h) / steps * 8.0 / (3.0 * std::numbers::pi);
}

class KernelBeyondLine : public testing::TestWithParam<double> {};

TEST_P(KernelBeyondLine, IsTheIntegralOfItsSlices) {
  const double h = GetParam();
  // The midpoint rule is off by some 1e-9 where the slope is infinite at most.
  EXPECT_NEAR(kernel_beyond({h, -5.0}, {h, 5.0}), beyond_line(h), 1e-8);
  EXPECT_NEAR(kernel_beyond({h, 5.0}, {h, -5.0}), -beyond_line(h), 1e-8);
}

INSTANTIATE_TEST_SUITE_P(Distances, KernelBeyondLine, testing::Values(1e-6, 0.1, 0.5, 0.9, 0.999));

TEST(KernelBeyond, LinesOutOfReachCutOffNothing) {
  EXPECT_EQ(kernel_beyond({1.0, -5.0}, {1.0, 5.0}), 0.0);
  EXPECT_EQ(kernel_beyond({2.0, 3.0}, {2.0, 3.0}), 0.0);
  EXPECT_NEAR(kernel_beyond({0.5, 1.0}, {0.5, 5.0}), 0.0, 1e-15);  // beyond the disc along it
}

// An L whose inner corner the disc reaches over, and a triangle within it.
TEST(KernelWithin, OfPolygonsIsTheIntegralOverTheirInside) {
  const std::vector<std::vector<Eigen::Vector2d>> polygons = {
      {{-0.3, -0.4}, {2.0, -0.4}, {2.0, 0.2}, {0.1, 0.2}, {0.1, 2.0}, {-0.3, 2.0}},
      {{-0.2, -0.1}, {0.6, -0.3}, {0.1, 0.5}}};
  for (const auto& polygon : polygons) {
    constexpr double radius = 0.7;
    const Eigen::Vector3d center(3.0, -2.0, 1.0);
    std::vector<LightRegions::Edge> edges;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
      const Eigen::Vector2d& a = polygon[i];
      const Eigen::Vector2d& b = polygon[(i + 1) % polygon.size()];
      edges.push_back({center + radius * Eigen::Vector3d(a.x(), a.y(), 0.0),
                       center + radius * Eigen::Vector3d(b.x(), b.y(), 0.0)});
    }
    const auto is_inside = [&](double x, double y) {
      bool inside = false;
      for (std::size_t i = 0; i < polygon.size(); ++i) {
        const Eigen::Vector2d& a = polygon[i];
        const Eigen::Vector2d& b = polygon[(i + 1) % polygon.size()];
        if ((a.y() > y) != (b.y() > y) &&
            x < a.x() + (y - a.y()) / (b.y() - a.y()) * (b.x() - a.x()))
          inside = !inside;
      }
      return inside;
    };
    constexpr int steps = 1000;
    double sum = 0.0;
    for (int i = 0; i < steps; ++i) {
      for (int j = 0; j < steps; ++j) {
        const double x = 2.0 * (i + 0.5) / steps - 1.0, y = 2.0 * (j + 0.5) / steps - 1.0;
        if (is_inside(x, y)) sum += kernel(x, y);
      }
    }
    sum *= 4.0 / (steps * steps);
    // Cells of 0.002 along some 4 of boundary, in or out by chance: sqrt(2000) cells of 4e-6 each,
    // where the kernel is 2 / pi at most; four times that.
    EXPECT_NEAR(kernel_within(center, Eigen::Vector3d::UnitZ(), radius, edges), sum, 5e-4);
  }
}

}  // namespace
}  // namespace lightwell
