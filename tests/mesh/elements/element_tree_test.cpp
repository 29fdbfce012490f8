#include "mesh/elements/element_tree.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <set>

#include "mesh/build_patches.h"
#include "mesh/elements/element_caster.h"
#include "mesh/elements/refine_elements.h"
#include "mesh/patches/patch_sampler.h"
#include "scene/sampling.h"
#include "tests/mesh/mesh_scenes.h"

namespace lightwell::element_tree_test {
namespace {

using namespace test;

using Eigen::Vector3d;

// Squares, other quadrilaterals, triangles and a ball; sheets with two sides, and boxes with one.
Scene all_shapes() {
  Scene scene = cornell_box();
  Loop kite{{0.1, 0, 0.1}, {0.25, 0, 0.15}, {0.3, 0, 0.3}, {0.1, 0, 0.2}};
  for (Vector3d& p : kite) p.y() = 0.3 + 0.1 * p.x() + 0.2 * p.z();
  add_polygon(scene, "kite", kite);
  add_sphere(scene, "ball", {.center = {0.3, 0.48, 0.1}, .radius = 0.03});
  return scene;
}

std::vector<int> some(const std::vector<int>& of, Numbers& numbers, int one_in) {
  std::vector<int> chosen;
  for (const int cell : of) {
    if (numbers.below(one_in) == 0) chosen.push_back(cell);
  }
  return chosen;
}

TEST(ElementTree, FindsElementsWhereACasterOfThemMeetsThem) {
  const Scene scene = all_shapes();
  const PatchMesh base = build_patches(scene, {.max_patch_size = 0.2});
  const ElementCaster at_base(base);
  Numbers numbers(7);
  RefinedElements elements(base);
  for (int round = 0; round < 5; ++round) elements.split(some(elements.leaves(), numbers, 4));
  const RefinedMesh refined = elements.mesh();
  const PatchMesh& mesh = refined.mesh;
  const ElementCaster through_base(mesh, at_base, refined.tree), caster(mesh);
  constexpr double away = 1e-3;  // nothing in the scene is that close to anything else
  std::set<std::pair<int, bool>> kinds;
  int places = 0, other_elements = 0;
  double worst = 0.0;
  for (int e = 0; e < mesh.element_count(); ++e) {
    const PatchSampler sampler(mesh, mesh.patch[e], e);
    for (std::uint64_t i = 0; i < 4; ++i) {
      const PatchPoint point = sampler.point(random_uniform(random_key(e, 2 * i)),
                                             random_uniform(random_key(e, 2 * i + 1)));
      const Ray ray{.origin = point.position + away * point.normal, .direction = -point.normal};
      ElementHit met, found;
      caster.closest_hits({&ray, 1}, {&met, 1});
      through_base.closest_hits({&ray, 1}, {&found, 1});
      ASSERT_EQ(found.facet, met.facet);
      ASSERT_EQ(found.from_back, met.from_back);
      ASSERT_NEAR(found.t, met.t, 1e-6);
      ElementHit alone;
      through_base.closest_elements({&ray, 1}, {&alone, 1});
      ASSERT_EQ(alone.element, found.element);
      ++places;
      if (found.element != met.element) ++other_elements;  // possible on a common edge
      ASSERT_NEAR(found.weights.sum(), 1.0f, 1.2e-7f);     // four roundings of up to 3e-8
      ASSERT_GE(found.weights.minCoeff(), -2.4e-7f);
      if (refined.cell[e] < 0) {
        ASSERT_TRUE((found.weights == met.weights).all());
        continue;
      }
      Vector3d at = Vector3d::Zero();
      for (int c = 0; c < mesh.corner_count(found.element); ++c) {
        at += double{found.weights[c]} * mesh.position(mesh.corners[found.element][c]);
      }
      worst = std::max(worst, (at - point.position).norm());
      kinds.insert({mesh.corner_count(found.element), found.from_back});
    }
  }
  std::printf("%d places, %d in a neighbour, %.2g m off at most\n", places, other_elements, worst);
  EXPECT_LT(other_elements, 1e-4 * places);
  // A hit is known to 6e-8 (float) of 0.5 m along each axis, and weights to as much of an element.
  EXPECT_LT(worst, 2e-7);
  EXPECT_EQ(kinds.size(), 4u);
}

TEST(ElementTree, HidesWhatTheBaseHides) {
  Scene scene = empty_scene();
  add_polygon(scene, "floor", {{0, 0, 0}, {2, 0, 0}, {2, 2, 0}, {0, 2, 0}});
  add_box(scene, "box", {0.5, 0.5, 0}, {1.2, 1.1, 0.4});
  const PatchMesh base = build_patches(scene, {.max_patch_size = 0.5});
  const ElementCaster at_base(base);
  Numbers numbers(3);
  RefinedElements elements(base);
  for (int round = 0; round < 3; ++round) elements.split(some(elements.leaves(), numbers, 3));
  const RefinedMesh refined = elements.mesh();
  const ElementCaster through_base(refined.mesh, at_base, refined.tree), caster(refined.mesh);
  int hidden = 0;
  for (int e = 0; e < refined.mesh.element_count(); ++e) {
    if (refined.mesh.is_back[refined.mesh.patch[e]]) continue;
    for (const bool from_back : {false, true}) {
      ASSERT_EQ(through_base.is_hidden(e, from_back), caster.is_hidden(e, from_back));
      hidden += caster.is_hidden(e, from_back) ? 1 : 0;
    }
  }
  EXPECT_GT(hidden, 10);
}

TEST(ElementTree, IsOfElementsThatAreNotSplitTwice) {
  Scene scene = empty_scene();
  add_polygon(scene, "floor", {{0, 0, 0}, {2, 0, 0}, {2, 2, 0}, {0, 2, 0}});
  const PatchMesh base = build_patches(scene, {.max_patch_size = 0.5});
  const ElementCaster at_base(base);
  RefinedElements elements(base);
  const RefinedMesh refined = elements.mesh();
  const ElementCaster once(refined.mesh, at_base, refined.tree);
  EXPECT_THROW(ElementCaster(refined.mesh, once, refined.tree), std::invalid_argument);
}

}  // namespace
}  // namespace lightwell::element_tree_test
