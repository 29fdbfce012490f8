#include "raytrace/product_cuts/gather_tree.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <vector>

#include "tests/raytrace/product_cuts/lamp_hall.h"

namespace lightwell::gather_tree_test {
namespace {

std::vector<PixelPoint> some_points(const TracedScene& lit) {
  std::vector<PixelPoint> points = test::points_about(lit, 1, 20, 0.3);
  const std::vector<PixelPoint> others = test::points_about(lit, 2, 13, 0.1);
  points.insert(points.end(), others.begin(), others.end());
  return points;
}

// Checks that a node holds all of its points; returns their numbers.
std::vector<int> expect_holds(const GatherTree& tree, int number,
                              const std::vector<PixelPoint>& points) {
  const GatherNode& node = tree.node(number);
  std::vector<int> all;
  if (tree.is_cluster(number)) {
    all = expect_holds(tree, node.child, points);
    const std::vector<int> second = expect_holds(tree, node.child + 1, points);
    all.insert(all.end(), second.begin(), second.end());
  } else {
    all = {node.point};
  }
  double strength = 0.0;
  for (const int i : all) {
    const PixelPoint& point = points[static_cast<std::size_t>(i)];
    strength += point.strength();
    // Middle and half are each rounded by 2^-53 of the place, which is below 20 m.
    const Eigen::Vector3d off = (point.at.position - node.middle).cwiseAbs() - node.half;
    EXPECT_LE(off.maxCoeff(), 20.0 * 4.0 * 0x1p-53);
    // The cosine is of unit vectors, each normalized to a few 2^-53.
    EXPECT_GE(node.axis.dot(point.at.normal), node.cosine - 8.0 * 0x1p-53);
  }
  // Sums of at most 33 terms in another order.
  EXPECT_NEAR(node.strength, strength, 2.0 * 33.0 * 0x1p-53 * strength);
  return all;
}

TEST(GatherTree, NodesHoldPlacesAndNormalsOfTheirPoints) {
  const TracedScene lit(test::lamp_hall(1, 1));
  const std::vector<PixelPoint> points = some_points(lit);
  std::vector<int> all = expect_holds(GatherTree(points, 5.0), 0, points);
  std::ranges::sort(all);
  for (int i = 0; i < static_cast<int>(points.size()); ++i) {
    EXPECT_EQ(all[static_cast<std::size_t>(i)], i);
  }
}

LightNode lamp_at(const Eigen::Vector3d& place) {
  return {.middle = place, .half = Eigen::Vector3d::Constant(0.1), .radius = 0.1 * std::sqrt(3.0)};
}

TEST(GatherTree, DrawsPointsByTheirChances) {
  const TracedScene lit(test::lamp_hall(1, 1));
  const std::vector<PixelPoint> points = some_points(lit);
  const GatherTree tree(points, 5.0);
  for (int k = 0; k < 10; ++k) {
    const LightNode lamp = lamp_at(points[0].at.position + 3.0 * test::unit_direction(k, 50));
    constexpr int draws = 1 << 14;
    std::map<int, double> drawn, chance;
    for (int i = 0; i < draws; ++i) {
      const GatherTree::Draw draw = tree.draw(0, lamp, (i + 0.5) / draws);
      drawn[draw.point] += 1.0 / draws;
      chance[draw.point] = draw.chance;
    }
    for (const auto& [point, share] : drawn) {
      // Each end of a point's interval is known to one draw.
      if (point >= 0) {
        EXPECT_NEAR(share, chance[point], 2.0 / draws) << point;
      }
    }
    // A point in front of the lamp is drawn.
    for (std::size_t i = 0; i < points.size(); ++i) {
      const Eigen::Vector3d to = lamp.middle - points[i].at.position;
      if (to.dot(points[i].at.normal) > 0.3 * to.norm()) {
        EXPECT_GT(drawn[static_cast<int>(i)], 0.0) << i;
      }
    }
  }
}

// Two points at distances of 1 and 2 m below a lamp get 4 to 1 of its light.
TEST(GatherTree, DrawsPointsByWhatTheyGet) {
  std::vector<PixelPoint> points;
  for (const double z : {1.0, 0.0}) {
    points.push_back(
        {.at = {{0, 0, z}, Eigen::Vector3d::UnitZ(), -1}, .weight = Spectrum::Ones(3)});
  }
  LightNode lamp;
  lamp.middle = {0, 0, 2};
  // Square and cube of 1 and 2, and their sum, are exact.
  EXPECT_EQ(GatherTree(points, 5.0).draw(0, lamp, 0.0).chance, 0.2);
  EXPECT_EQ(GatherTree(points, 5.0).draw(0, lamp, 0.99).chance, 0.8);
}

// A corner of a room seen through one pixel: points of floor and wall lie side by side.
TEST(GatherTree, PartsSurfacesThatFaceElsewhereFirst) {
  std::vector<PixelPoint> points;
  for (int i = 0; i < 8; ++i) {
    const bool is_floor = i % 2 == 0;
    points.push_back({.at = {{0.01 * i, is_floor ? 0.01 : 0.0, is_floor ? 0.0 : 0.01},
                             is_floor ? Eigen::Vector3d::UnitZ() : Eigen::Vector3d::UnitY(),
                             -1},
                      .weight = Spectrum::Ones(3)});
  }
  const GatherTree tree(points, 5.0);
  for (const int half : {1, 2}) EXPECT_EQ(tree.node(half).cosine, 1.0);
}

}  // namespace
}  // namespace lightwell::gather_tree_test
