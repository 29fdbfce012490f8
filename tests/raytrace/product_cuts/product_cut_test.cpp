#include "raytrace/product_cuts/product_cut.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "tests/raytrace/product_cuts/lamp_hall.h"

namespace lightwell::product_cut_test {
namespace {

std::vector<int> points_of(const GatherTree& tree, int number) {
  if (!tree.is_cluster(number)) return {tree.node(number).point};
  std::vector<int> all = points_of(tree, tree.node(number).child);
  const std::vector<int> second = points_of(tree, tree.node(number).child + 1);
  all.insert(all.end(), second.begin(), second.end());
  return all;
}

std::vector<int> lights_of(const LightTree& tree, int number) {
  if (!tree.is_cluster(number)) return {tree.light(number)};
  std::vector<int> all = lights_of(tree, tree.node(number).child);
  const std::vector<int> second = lights_of(tree, tree.node(number).child + 1);
  all.insert(all.end(), second.begin(), second.end());
  return all;
}

// Checks the bounds of all pairs of a node of points and the nodes of lights below `light`; returns
// the irradiance of the lights at each point.
Eigen::ArrayXd expect_bounded(const LightTree& lights, int light, const GatherTree& points,
                              const Eigen::ArrayXXd& E, const std::vector<std::vector<int>>& of) {
  Eigen::ArrayXd sum;
  if (lights.is_cluster(light)) {
    const int child = lights.node(light).child;
    sum = expect_bounded(lights, child, points, E, of) +
          expect_bounded(lights, child + 1, points, E, of);
  } else {
    sum = E.row(lights.light(light)).transpose();
  }
  for (std::size_t g = 0; g < of.size(); ++g) {
    const PairLight pair = pair_light(lights.node(light), points.node(static_cast<int>(g)));
    EXPECT_LE(pair.about, pair.bound);
    // Intensities are floats.
    for (const int i : of[g]) {
      EXPECT_LE(sum[i], pair.bound * (1.0 + 1e-6) + 1e-12) << light << ", " << g;
    }
  }
  return sum;
}

TEST(ProductCut, NoPairGivesMoreThanItsBound) {
  const TracedScene lit(test::lamp_hall(60, 60));
  const LightTree lights = test::tree_of(lit.direct_light);
  for (int cluster = 0; cluster < 20; ++cluster) {
    const std::vector<PixelPoint> points =
        test::points_about(lit, cluster, 9, cluster % 2 == 0 ? 0.05 : 2.0);
    const GatherTree tree(points, 5.0);
    std::vector<std::vector<int>> of;
    for (int g = 0; g < 17; ++g) of.push_back(points_of(tree, g));
    expect_bounded(lights, 0, tree, test::unoccluded(lit.direct_light, points), of);
  }
}

// Boxes of one point are those of the light tree. Only behind lights is a pair's bound narrower.
TEST(ProductCut, BoundsOfOnePointAreAsNarrowAsThoseOfTheLightTree) {
  const TracedScene lit(test::lamp_hall(60, 60));
  const LightTree lights = test::tree_of(lit.direct_light);
  int finite = 0;
  for (int k = 0; k < 50; ++k) {
    const std::vector<PixelPoint> point = test::points_about(lit, k, 1, 0.1);
    const GatherTree tree(point, 5.0);
    for (int n = 0; n < 119; ++n) {
      if (!lights.is_cluster(n)) continue;
      for (const LightTree::Seen& seen : lights.halves(n, point[0].at)) {
        const double bound = pair_light(lights.node(seen.node), tree.node(0)).bound;
        if (!std::isfinite(seen.bound)) continue;
        ++finite;
        // The same products in another order, some ten roundings.
        EXPECT_LE(bound, seen.bound * (1.0 + 10.0 * 0x1p-53) + 1e-15);
      }
    }
  }
  EXPECT_GT(finite, 1000);
}

TEST(ProductCut, HoldsEveryLightAtEveryPointOnce) {
  const TracedScene lit(test::lamp_hall(60, 60));
  const LightTree lights = test::tree_of(lit.direct_light);
  std::vector<PixelPoint> points = test::points_about(lit, 3, 20, 0.2);
  const std::vector<PixelPoint> far = test::points_about(lit, 4, 12, 0.2);
  points.insert(points.end(), far.begin(), far.end());
  const GatherTree tree(points, 5.0);
  const Eigen::ArrayXXd E = test::unoccluded(lit.direct_light, points);
  std::size_t before = 0;
  for (const double share : {0.1, 0.01, 0.0}) {
    const double light = 0.05 * tree.node(0).strength;
    const auto cut =
        product_cut({&lights}, tree, {.share = share, .light = light, .most = 1 << 20});
    double about = 0.0;
    for (const LightPair& pair : cut) about += pair.about;
    // The running sum of the cut is rounded at each of fewer than 10 000 pairs.
    const double most = share * std::max(light, 0.01 * about) * (1.0 + 1e4 * 0x1p-53);
    Eigen::ArrayXXi found = Eigen::ArrayXXi::Zero(E.rows(), E.cols());
    for (const LightPair& pair : cut) {
      const bool is_cluster = lights.is_cluster(pair.light) || tree.is_cluster(pair.gather);
      if (is_cluster) {
        EXPECT_LE(pair.bound, most) << share;
      }
      for (const int l : lights_of(lights, pair.light)) {
        for (const int p : points_of(tree, pair.gather)) ++found(l, p);
      }
    }
    EXPECT_TRUE((found <= 1).all());
    // Light below what rounding of the bound's cosine leaves of nothing.
    EXPECT_TRUE((found == 1 || E < 1e-12).all());
    EXPECT_GT(cut.size(), before);
    before = cut.size();
  }
}

TEST(ProductCut, EndsAtTheMostPairs) {
  const TracedScene lit(test::lamp_hall(60, 60));
  const LightTree lights = test::tree_of(lit.direct_light);
  const std::vector<PixelPoint> points = test::points_about(lit, 3, 64, 0.2);
  const GatherTree tree(points, 5.0);
  const auto cut = product_cut({&lights}, tree, {.share = 0.0, .light = 1.0, .most = 100});
  EXPECT_GE(cut.size(), 90U);
  // The last pair that is parted adds one.
  EXPECT_LE(cut.size(), 101U);
}

}  // namespace
}  // namespace lightwell::product_cut_test
