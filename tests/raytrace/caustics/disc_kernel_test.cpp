#include "raytrace/caustics/disc_kernel.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

namespace lightwell::disc_kernel_test {
namespace {

double kernel(double x, double y) {
  return std::max(0.0, 2.0 / std::numbers::pi * (1.0 - x * x - y * y));
}

// Share of the kernel beyond a line at distance h. The integral of the kernel along a line at
// distance x is 8 / (3 pi) (1 - x^2)^(3/2).
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
  const double segment = (std::acos(h) - h * std::sqrt(1.0 - h * h)) / std::numbers::pi;
  EXPECT_NEAR(disc_beyond({h, -5.0}, {h, 5.0}), segment, 1e-12);
}

INSTANTIATE_TEST_SUITE_P(Distances, KernelBeyondLine, testing::Values(1e-6, 0.1, 0.5, 0.9, 0.999));

TEST(KernelBeyond, LinesOutOfReachCutOffNothing) {
  EXPECT_EQ(kernel_beyond({1.0, -5.0}, {1.0, 5.0}), 0.0);
  EXPECT_EQ(kernel_beyond({2.0, 3.0}, {2.0, 3.0}), 0.0);
  EXPECT_NEAR(kernel_beyond({0.5, 1.0}, {0.5, 5.0}), 0.0, 1e-15);  // beyond the disc along it
}

using Polygon = std::vector<Eigen::Vector2d>;

std::vector<LightRegions::Edge> edges_of(const Polygon& polygon, const Eigen::Vector3d& center,
                                         double scale) {
  std::vector<LightRegions::Edge> edges;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Eigen::Vector2d& a = polygon[i];
    const Eigen::Vector2d& b = polygon[(i + 1) % polygon.size()];
    edges.push_back({center + scale * Eigen::Vector3d(a.x(), a.y(), 0.0),
                     center + scale * Eigen::Vector3d(b.x(), b.y(), 0.0)});
  }
  return edges;
}

bool is_inside(const Polygon& polygon, double x, double y) {
  bool inside = false;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Eigen::Vector2d& a = polygon[i];
    const Eigen::Vector2d& b = polygon[(i + 1) % polygon.size()];
    if ((a.y() > y) != (b.y() > y) && x < a.x() + (y - a.y()) / (b.y() - a.y()) * (b.x() - a.x())) {
      inside = !inside;
    }
  }
  return inside;
}

// A right corner, a sharp one, an L whose inner corner the disc reaches over, and a sliver.
const std::vector<Polygon> areas = {
    {{-0.3, -0.4}, {5.0, -0.4}, {5.0, 5.0}, {-0.3, 5.0}},
    {{-0.3, -0.2}, {5.0, -0.2}, {3.0, 3.0}},
    {{-0.3, -0.4}, {2.0, -0.4}, {2.0, 0.2}, {0.1, 0.2}, {0.1, 2.0}, {-0.3, 2.0}},
    {{-0.2, -0.1}, {0.6, -0.3}, {0.1, 0.5}}};

// The kernel within the area plus the parts folded back is the whole kernel: power is conserved.
TEST(FoldedDisc, GivesAllOfItsKernelToTheInside) {
  constexpr double scale = 0.7;
  const Eigen::Vector3d center(3.0, -2.0, 1.0);
  for (const Polygon& area : areas) {
    const FoldedDisc disc =
        fold(center, Eigen::Vector3d::UnitZ(), scale, edges_of(area, center, scale));
    constexpr int steps = 1500;
    double sum = 0.0;
    for (int i = 0; i < steps; ++i) {
      for (int j = 0; j < steps; ++j) {
        const double x = 6.0 * (i + 0.5) / steps - 3.0, y = 6.0 * (j + 0.5) / steps - 3.0;
        if (!is_inside(area, x, y)) continue;
        sum += kernel(x, y);
        for (const Eigen::Vector3d& c : disc.mirrored) {
          const Eigen::Vector3d off = (c - center) / scale;
          sum += kernel(x - off.x(), y - off.y());
        }
      }
    }
    sum *= 36.0 / (steps * steps);
    // Some 1000 cells of edge 0.004 along a boundary of length 4 are inside or outside at random:
    // the standard error is sqrt(1000) cells of area 1.6e-5, with a kernel of about 1; three of
    // them.
    EXPECT_NEAR(disc.within, sum, 1.5e-3);
  }
}

TEST(FoldedDisc, InARightCornerNothingIsMissing) {
  const FoldedDisc disc = fold(Eigen::Vector3d::Zero(), Eigen::Vector3d::UnitZ(), 1.0,
                               edges_of(areas[0], Eigen::Vector3d::Zero(), 1.0));
  EXPECT_EQ(disc.mirrored.size(), 3u);
  EXPECT_NEAR(disc.within, 1.0, 1e-12);
}

TEST(FoldedDisc, FarFromEdgesItIsWhole) {
  const Polygon far = {{-3, -3}, {3, -3}, {3, 3}, {-3, 3}};
  const FoldedDisc disc = fold(Eigen::Vector3d::Zero(), Eigen::Vector3d::UnitZ(), 1.0,
                               edges_of(far, Eigen::Vector3d::Zero(), 1.0));
  EXPECT_TRUE(disc.mirrored.empty());
  EXPECT_EQ(disc.within, 1.0);
}

}  // namespace
}  // namespace lightwell::disc_kernel_test
