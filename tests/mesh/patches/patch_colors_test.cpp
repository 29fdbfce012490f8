#include "mesh/patches/patch_colors.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <map>
#include <set>

#include "mesh/build_patches.h"
#include "tests/mesh/mesh_scenes.h"

namespace lightwell::patch_colors_test {
namespace {

using namespace lightwell::test;

// The patches of front elements by edge, with ends rounded to 1e-7 m: far above the rounding of
// positions in these scenes of about a metre, far below the size of their elements.
std::map<std::set<std::array<long, 3>>, std::set<int>> patches_at_sides(const PatchMesh& mesh) {
  const auto rounded = [&mesh](int vertex) {
    const Eigen::Vector3d p = mesh.position(vertex) * 1e7;
    return std::array<long, 3>{std::lround(p.x()), std::lround(p.y()), std::lround(p.z())};
  };
  std::map<std::set<std::array<long, 3>>, std::set<int>> result;
  for (int e = 0; e < mesh.element_count(); ++e) {
    if (mesh.is_back[mesh.patch[e]]) continue;
    const int n = mesh.corner_count(e);
    for (int i = 0; i < n; ++i) {
      result[{rounded(mesh.corners[e][i]), rounded(mesh.corners[e][(i + 1) % n])}].insert(
          mesh.patch[e]);
    }
  }
  return result;
}

void expect_neighbours_differ(const PatchMesh& mesh) {
  const std::vector<int> color = patch_colors(mesh);
  ASSERT_EQ(static_cast<int>(color.size()), mesh.patch_count());
  int pairs = 0;
  for (const auto& [side, patches] : patches_at_sides(mesh)) {
    std::set<int> colors;
    for (const int p : patches) {
      ASSERT_GE(color[p], 0);
      colors.insert(color[p]);
    }
    EXPECT_EQ(colors.size(), patches.size());
    pairs += patches.size() > 1 ? 1 : 0;
  }
  EXPECT_GT(pairs, 0);
}

TEST(PatchColors, NeighboursDifferAcrossFacetsSurfacesAndContactLines) {
  expect_neighbours_differ(build_patches(cornell_box(), {.max_patch_size = 0.1}));
  expect_neighbours_differ(
      build_patches(cornell_box(), {.max_patch_size = 0.1, .discontinuity = true}));
  for (const std::uint32_t seed : {2u, 3u, 5u}) {
    expect_neighbours_differ(build_patches(boxes_under_a_lamp(seed), {.max_patch_size = 0.4}));
  }
  Scene scene = empty_scene();
  add_sphere(scene, "exact", {{5, 0, 0}, 1.0});
  expect_neighbours_differ(build_patches(scene, {.max_patch_size = 0.3}));
  expect_neighbours_differ(build_patches(triangle_ball(40, 0), {.max_patch_size = 0.4}));
}

TEST(PatchColors, AGridTakesTwoAndBacksHaveTheirFronts) {
  Scene scene = empty_scene();
  add_polygon(scene, "wall", {{0, 0, 0}, {3, 0, 0}, {3, 2, 0}, {0, 2, 0}});
  const PatchMesh mesh = build_patches(scene, {.max_patch_size = 0.5});
  const std::vector<int> color = patch_colors(mesh);
  EXPECT_EQ(*std::max_element(color.begin(), color.end()), 1);
  ASSERT_EQ(mesh.patch_count(), 48);
  for (int e = 0; e < mesh.element_count(); ++e) {
    EXPECT_EQ(color[mesh.patch[e]], color[mesh.patch[mesh.twin[e]]]);
  }
}

}  // namespace
}  // namespace lightwell::patch_colors_test
