#include "radiosity/many_lights/light_tree.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <utility>
#include <vector>

#include "radiosity/direct_light/direct_light.h"
#include "tests/radiosity/many_lights/many_lamp_hall.h"

namespace lightwell::light_tree_test {
namespace {

using Eigen::Vector3d;
using test::ManyLampHall, test::point_in_hall, test::tree_of, test::unoccluded;

/// Checks the bound of a node and of all nodes below; returns the light of the node.
double expect_bounded(const LightTree& tree, const LightTree::Seen& seen, const SurfacePoint& at,
                      const std::vector<double>& E) {
  double sum = 0.0;
  if (tree.is_cluster(seen.node)) {
    for (const auto& half : tree.halves(seen.node, at)) sum += expect_bounded(tree, half, at, E);
  } else {
    sum = E[static_cast<std::size_t>(tree.light(seen.node))];
  }
  // Intensities are floats.
  EXPECT_LE(sum, seen.bound * (1.0 + 1e-6) + 1e-12) << "node " << seen.node;
  return sum;
}

void expect_bounds(const ManyLampHall& hall) {
  const DirectLight light(hall.scene, hall.mesh);
  const LightTree tree = tree_of(light);
  for (int k = 0; k < 200; ++k) {
    const SurfacePoint at = point_in_hall(k);
    const std::vector<double> E = unoccluded(light, at);
    double all = 0.0;
    for (const double of_one : E) all += of_one;
    // Two orders of the same sum of at most 120 terms, each rounded by 2^-53 of the sum.
    EXPECT_NEAR(expect_bounded(tree, tree.root(at), at, E), all, 2.0 * 120.0 * 0x1p-53 * all);
  }
}

TEST(LightTree, NoNodeGivesMoreThanItsBound) {
  expect_bounds(ManyLampHall(60, 60));
}

// Points of surfaces that send on light, some of them nearer than the limit of their kernel.
TEST(LightTree, NoNodeOfVirtualLightsGivesMoreThanItsBound) {
  const ManyLampHall hall(1, 0);
  std::vector<FreeSource> sources;
  constexpr int count = 200;
  for (int k = 0; k < count; ++k) {
    sources.push_back({.number = k,
                       .light = constant_spectrum(hall.scene.bands, 1.0f + k % 7),
                       .shape = VirtualLight{.position = point_in_hall(k).position,
                                             .normal = test::unit_direction(k, 40),
                                             .most = 0.3}});
  }
  const LightTree tree(bounds_of(sources, 0));
  const DirectLight light(hall.scene, std::move(sources), nullptr);
  EXPECT_EQ(light.light_count(), count);
  for (int k = 0; k < 200; ++k) {
    const SurfacePoint at = point_in_hall(k + count);
    expect_bounded(tree, tree.root(at), at, unoccluded(light, at));
  }
}

TEST(LightTree, PanelsThatFaceDownGiveNothingAbove) {
  const ManyLampHall hall(60, 0, true);
  expect_bounds(hall);
  const DirectLight light(hall.scene, hall.mesh);
  const LightTree tree = tree_of(light);
  const SurfacePoint above{.position = {0, 0, 5.9}, .normal = -Vector3d::UnitZ(), .facet = -1};
  EXPECT_EQ(tree.root(above).bound, 0.0);
}

// The chances of the lights of a cluster, with those of none, add up to 1, and each light that
// gives something has one: the mean of light over chance is then the light of the cluster.
TEST(LightTree, DrawsEveryLightByItsChance) {
  const ManyLampHall hall(20, 20);
  const DirectLight light(hall.scene, hall.mesh);
  const LightTree tree = tree_of(light);
  int clusters = 0;
  for (int k = 0; k < 20; ++k) {
    const SurfacePoint at = point_in_hall(k);
    const std::vector<double> E = unoccluded(light, at);
    for (const CutPart& part : light_cut(roots({&tree}, at), at, {.share = 0.2, .most = 1 << 20})) {
      if (!tree.is_cluster(part.seen.node)) continue;
      ++clusters;
      // The chances follow from how often each light is drawn, to 1/draws at each of its ends.
      constexpr int draws = 1 << 14;
      std::map<int, double> drawn, chance;
      for (int i = 0; i < draws; ++i) {
        const LightTree::Draw draw = tree.draw(part.seen.node, at, (i + 0.5) / draws);
        drawn[draw.light] += 1.0 / draws;
        chance[draw.light] = draw.chance;
      }
      for (const auto& [number, share] : drawn) {
        if (number < 0) continue;
        EXPECT_NEAR(share, chance[number], 2.0 / draws);
        // Weights hold cosines and distances of middles, where bounds hold the nearest point's.
        EXPECT_LE(E[static_cast<std::size_t>(number)] / chance[number], 4.0 * part.seen.bound);
      }
    }
  }
  EXPECT_GT(clusters, 20);
}

TEST(LightTree, CutsHaveNoClusterAboveTheShare) {
  const ManyLampHall hall(100, 100);
  const DirectLight light(hall.scene, hall.mesh);
  const LightTree tree = tree_of(light);
  for (int k = 0; k < 50; ++k) {
    const SurfacePoint at = point_in_hall(k);
    // A finer cut has the single lights of a coarser one, and more. Halves that give nothing are
    // left out, so that the finer cut may have fewer parts.
    int before = 0;
    for (const double share : {0.1, 0.02, 0.0}) {
      int singles = 0;
      for (const CutPart& part :
           light_cut(roots({&tree}, at), at, {.share = share, .light = 7.0, .most = 1 << 20})) {
        if (tree.is_cluster(part.seen.node)) {
          EXPECT_LE(part.seen.bound, share * 7.0);
        } else {
          ++singles;
        }
      }
      EXPECT_GE(singles, before);
      before = singles;
    }
    // Single lights alone, as far as they give anything.
    for (const CutPart& part :
         light_cut(roots({&tree}, at), at, {.share = 0.0, .light = 7.0, .most = 1 << 20})) {
      EXPECT_FALSE(tree.is_cluster(part.seen.node));
    }
  }
}

TEST(LightTree, ManyLightsAtOnePlaceAreOneCluster) {
  std::vector<LightBound> lights(1000);
  for (int k = 0; k < 1000; ++k) {
    lights[k].light = k;
    lights[k].box = {Vector3d(1, 2, 3), Vector3d(1, 2, 3)};
    lights[k].intensity.fill(2.0f);
  }
  const LightTree tree(std::move(lights));
  const SurfacePoint at{.position = {1, 2, 0}, .normal = Vector3d::UnitZ()};
  const LightTree::Seen root = tree.root(at);
  // Sums of powers of two times 1000 are exact in float; the quotient by 3^2 and the cosine take
  // four roundings, the quotient by 3^3 five.
  EXPECT_NEAR(root.bound, 1000 * 2.0 / 9.0, 4.0 * 0x1p-53 * root.bound);
  EXPECT_NEAR(root.about, root.bound, 9.0 * 0x1p-53 * root.bound);
  const LightTree::Draw draw = tree.draw(root.node, at, 0.75);
  // Ten halvings, each the product of a share with three roundings.
  EXPECT_NEAR(draw.chance, 1e-3, 10.0 * 4.0 * 0x1p-53 * 1e-3);
}

}  // namespace
}  // namespace lightwell::light_tree_test
