#include "radiosity/visibility/convex_polygon.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

#include "scene/sampling.h"

namespace lightwell::convex_polygon_test {
namespace {

using Eigen::Vector3d;
using Loop = std::vector<Vector3d>;

// Rounding of areas near 1.
constexpr double rounding = 1e-12;

ConvexPolygon square() {
  const Loop corners = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  return ConvexPolygon(corners);
}

bool is_convex(const ConvexPolygon& p, const Vector3d& normal) {
  for (int k = 0; k < p.count; ++k) {
    const Vector3d in = p.corner[(k + 1) % p.count] - p.corner[k];
    const Vector3d out = p.corner[(k + 2) % p.count] - p.corner[(k + 1) % p.count];
    if (in.cross(out).dot(normal) < -rounding) return false;
  }
  return true;
}

double total_area(const std::vector<ConvexPolygon>& pieces) {
  double sum = 0.0;
  for (const ConvexPolygon& p : pieces) sum += p.area();
  return sum;
}

TEST(ConvexPolygon, IsCutInTwoThatAddUp) {
  for (std::uint64_t k = 0; k < 100; ++k) {
    const auto u = [&](std::uint64_t d) { return 2.0 * random_uniform(random_key(k, d)) - 1.0; };
    const HalfSpace plane{Vector3d(u(0), u(1), u(2)).normalized(), 0.5 * u(3)};
    ConvexPolygon inside, outside;
    const Cut cut = split(square(), plane, inside, outside);
    if (cut != Cut::both) continue;
    EXPECT_NEAR(inside.area() + outside.area(), 1.0, rounding);
    for (const Vector3d& p : inside.corners()) EXPECT_GE(plane.height(p), -rounding);
    for (const Vector3d& p : outside.corners()) EXPECT_LE(plane.height(p), rounding);
  }
}

TEST(ConvexPolygon, IsLeftWholeByPlanesThatOnlyTouchIt) {
  ConvexPolygon inside, outside;
  EXPECT_EQ(split(square(), {Vector3d::UnitX(), 0.0}, inside, outside), Cut::all_inside);
  EXPECT_EQ(split(square(), {Vector3d::UnitX(), 1.0}, inside, outside), Cut::none_inside);
  // A sliver of the size of rounding.
  EXPECT_EQ(split(square(), {Vector3d::UnitX(), 1e-14}, inside, outside), Cut::all_inside);
}

TEST(ConvexPieces, TileWhatTheyAreCutFrom) {
  const Vector3d up = Vector3d::UnitZ();
  const Loop ell = {{0, 0, 0}, {2, 0, 0}, {2, 1, 0}, {1, 1, 0}, {1, 2, 0}, {0, 2, 0}};
  const auto of_ell = convex_pieces({ell}, up);
  EXPECT_EQ(of_ell.size(), 2u);
  EXPECT_NEAR(total_area(of_ell), 3.0, rounding);

  const Loop wall = {{0, 0, 0}, {4, 0, 0}, {4, 3, 0}, {0, 3, 0}};
  const Loop window = {{1, 1, 0}, {1, 2, 0}, {2, 2, 0}, {2, 1, 0}};
  const auto of_wall = convex_pieces({wall, window}, up);
  EXPECT_NEAR(total_area(of_wall), 11.0, rounding);
  EXPECT_LE(of_wall.size(), 5u);  // 4 at best

  // The star runs twice around its centre: left turns everywhere, but not convex.
  Loop star;
  for (int k = 0; k < 5; ++k) {
    const double angle = 0.8 * std::numbers::pi * k;
    star.emplace_back(std::cos(angle), std::sin(angle), 0.0);
  }
  EXPECT_TRUE(convex_pieces({star}, up).empty());

  Loop disk;
  constexpr int sides = 40;
  for (int k = 0; k < sides; ++k) {
    const double angle = 2.0 * std::numbers::pi * k / sides;
    disk.emplace_back(std::cos(angle), std::sin(angle), 0.0);
  }
  const auto of_disk = convex_pieces({disk}, up);
  EXPECT_NEAR(total_area(of_disk), 0.5 * sides * std::sin(2.0 * std::numbers::pi / sides),
              rounding);
  for (const auto* pieces : {&of_ell, &of_wall, &of_disk}) {
    for (const ConvexPolygon& p : *pieces) {
      EXPECT_TRUE(is_convex(p, up));
      EXPECT_LE(p.count, 12);
    }
  }
}

TEST(ConvexHull, HoldsAllPointsThoughManyLieOnItsEdges) {
  const Vector3d up = Vector3d(0.3, -0.5, 0.9).normalized();
  Vector3d x, y;
  tangent_frame(up, x, y);
  // Corners of a square many times over, each a little off, and points along its edges.
  std::vector<Vector3d> points;
  for (std::uint64_t k = 0; k < 200; ++k) {
    const auto noise = [&](std::uint64_t d) {
      return 1e-16 * (random_uniform(random_key(k, d)) - 0.5);
    };
    const double end = static_cast<double>(k >> 3 & 1), side = static_cast<double>(k >> 1 & 1);
    const double along = k % 4 == 0 ? random_uniform(random_key(k, 7)) : end;
    const double a = k % 3 == 0 ? along : side, b = k % 3 == 0 ? side : along;
    points.push_back((a + noise(0)) * x + (b + noise(1)) * y);
  }
  const ConvexPolygon hull = convex_hull(points, up);
  EXPECT_NEAR(hull.area(), 1.0, 1e-8);  // rounding of points is 1e-9
  EXPECT_TRUE(is_convex(hull, up));
}

}  // namespace
}  // namespace lightwell::convex_polygon_test
