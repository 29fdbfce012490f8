#include "scene/sky_patches.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <numbers>
#include <set>
#include <stdexcept>

namespace lightwell::sky_patches_test {
namespace {

using Eigen::Vector3d;
using std::numbers::pi;

SkyPatches patches(int subdivision) {
  return SkyPatches(subdivision, Vector3d::UnitZ(), Vector3d::UnitY());
}

}  // namespace

TEST(SkyPatches, AreTregenzasAndReinharts) {
  EXPECT_EQ(patches(1).dome_count(), 145);
  EXPECT_EQ(patches(2).dome_count(), 577);
  EXPECT_EQ(patches(4).dome_count(), 2305);
  EXPECT_THROW(patches(0), std::invalid_argument);
  EXPECT_THROW(patches(9), std::invalid_argument);
}

TEST(SkyPatches, CoverTheSphereOnce) {
  for (const int m : {1, 2, 3}) {
    const SkyPatches sky = patches(m);
    double sum = 0.0;
    for (int c = 0; c < sky.cell_count(); ++c) {
      sum += sky.solid_angle(c);
      for (const double u : {0.01, 0.5, 0.99}) {
        for (const double v : {0.01, 0.5, 0.99}) {
          ASSERT_EQ(sky.cell_of(sky.direction(c, u, v)), c) << m << " " << u << " " << v;
        }
      }
    }
    EXPECT_NEAR(sum, 4.0 * pi, 1e-12);
  }
}

TEST(SkyPatches, BeginInTheNorthAndTurnClockwise) {
  const SkyPatches sky = patches(1);
  const Vector3d north = Vector3d::UnitY(), east = Vector3d::UnitX();
  const Vector3d first = sky.direction(0, 0.5, 0.5), second = sky.direction(1, 0.5, 0.5);
  EXPECT_NEAR(first.dot(east), 0.0, 1e-12);
  EXPECT_GT(first.dot(north), 0.9);
  EXPECT_GT(second.dot(east), 0.1);
  EXPECT_EQ(sky.cell_of(Vector3d::UnitZ()), 144);
  EXPECT_EQ(sky.column_of(sky.cell_of(Vector3d(0.0, 0.9, -0.1).normalized())), sky.ground_column());
}

// A patch that touches another is touched by it, and steps across an edge lead to a neighbour.
TEST(SkyPatches, NeighboursAreMutual) {
  const SkyPatches sky = patches(2);
  for (int c = 0; c < sky.cell_count(); ++c) {
    const auto& beside = sky.neighbours(c);
    const std::set<int> known(beside.begin(), beside.end());
    for (const int n : beside) {
      EXPECT_EQ(std::ranges::count(sky.neighbours(n), c), 1);
    }
    const Vector3d middle = sky.direction(c, 0.5, 0.5);
    for (const auto& [u, v] : {std::pair(0.0, 0.5), {1.0, 0.5}, {0.5, 0.0}, {0.5, 1.0}}) {
      const Vector3d beyond = (sky.direction(c, u, v) + 1e-3 * (sky.direction(c, u, v) - middle));
      const int other = sky.cell_of(beyond.normalized());
      EXPECT_TRUE(other == c || known.contains(other)) << c << " " << other;
    }
  }
}

// A dome of radiance 1 gives level ground pi, a wall pi / 2; the rest of the wall's sphere gives
// as much. The midpoint rule has 36 points a cell, so that cells which the wall's horizon cuts are
// known to some percent each, and their sum to 1e-4.
TEST(SkyPatches, EvenSkyGivesPi) {
  const SkyPatches sky = patches(2);
  const auto below = [&](const Eigen::ArrayXd& E) { return E.tail(sky.dome_count()).sum(); };
  const Eigen::ArrayXd level = sky.irradiances(Vector3d::UnitZ());
  EXPECT_NEAR(level.sum(), pi, 1e-12);
  EXPECT_NEAR(below(level), 0.0, 1e-12);
  const Eigen::ArrayXd wall = sky.irradiances(Vector3d::UnitX());
  EXPECT_NEAR(wall.sum(), pi, 3e-4);
  EXPECT_NEAR(below(wall), 0.5 * pi, 2e-4);
}

}  // namespace lightwell::sky_patches_test
