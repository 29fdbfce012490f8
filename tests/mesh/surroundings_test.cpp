// A small scene amid a ground or a dome of kilometres.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <utility>
#include <vector>

#include "mesh/build_patches.h"
#include "mesh/geometry/cut_size.h"
#include "mesh/patches/mesh_bounds.h"
#include "tests/mesh/mesh_scenes.h"

namespace lightwell::surroundings_test {
namespace {

using namespace lightwell::test;

// A cube of 1 m without a bottom that stands on a ground of the given length, or on none: facets 0
// to 4, and 5.
Scene cube_on_ground(double length) {
  Scene scene = empty_scene();
  add_polygon(scene, "top", {{0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}});
  for (const double z : {0.0, 1.0}) {
    add_polygon(scene, "wall", {{0, z, 0}, {1, z, 0}, {1, z, 1}, {0, z, 1}});
    add_polygon(scene, "side", {{z, 0, 0}, {z, 1, 0}, {z, 1, 1}, {z, 0, 1}});
  }
  add_polygon(scene, "shelf", {{0.1, 0.1, 0.4}, {0.9, 0.1, 0.4}, {0.9, 0.9, 0.4}, {0.1, 0.9, 0.4}});
  const double h = 0.5 * length;
  if (h > 0.0) add_polygon(scene, "ground", {{-h, -h, 0}, {h, -h, 0}, {h, h, 0}, {-h, h, 0}});
  return scene;
}

// The corners of all elements of the first `facets` facets, with the number of each one's patch.
std::vector<std::vector<double>> elements_of(const PatchMesh& mesh, int facets) {
  std::vector<std::vector<double>> elements;
  for (int e = 0; e < mesh.element_count(); ++e) {
    if (mesh.facet[e] >= facets) continue;
    std::vector<double>& element = elements.emplace_back();
    element.push_back(mesh.patch[e]);
    for (int c = 0; c < mesh.corner_count(e); ++c) {
      const Eigen::Vector3d at = mesh.position(mesh.corners[e][c]);
      element.insert(element.end(), {at.x(), at.y(), at.z()});
    }
  }
  return elements;
}

TEST(Surroundings, LeaveTheMeshOfWhatIsNearAsItIsAlone) {
  const auto alone = elements_of(build_patches(cube_on_ground(0.0)), 6);
  for (const double length : {300.0, 6000.0}) {
    EXPECT_EQ(elements_of(build_patches(cube_on_ground(length)), 6), alone) << length;
  }
}

// The edges of this ground are 10^10 near patches long, more than integers count. Each edge of
// length L is L/2 away.
// - A part of an edge is halved where distances d to the near box differ by a factor of 2 or more,
//   so by a third of d or more from the part's middle: parts of L and L/2 at most, which leaves 4.
// - Distances within a part differ by less than 4. Patches are half of the least distance long, or
//   half of that by whole levels: more than d/16, so L/32, and elements more than L/64.
// These are 64 elements, one more for each part, and one point more.
TEST(Surroundings, EdgesOfAMillionKilometresAreCutBySizesThere) {
  constexpr double length = 1e9;
  const Scene scene = cube_on_ground(length);
  ASSERT_GT(length / cut_size(scene, {}).patch_size, std::numeric_limits<int>::max());
  const PatchMesh mesh = build_patches(scene);
  std::set<std::pair<double, double>> on_edge;
  for (int v = 0; v < mesh.vertex_count(); ++v) {
    const Eigen::Vector3d at = mesh.position(v);
    if (at.y() == -0.5 * length) on_edge.emplace(at.x(), at.z());
  }
  EXPECT_GE(on_edge.size(), 2u);
  EXPECT_LE(on_edge.size(), 64u + 4u + 1u);
}

// No element of a ground is longer than a diagonal of one and a half cells, the most that leaving
// out points near lines makes of a cell's half; elements that cells of two sizes share count as the
// larger's, so that twice that is allowed.
TEST(Surroundings, GroundIsFineNearTheSceneryAndConforms) {
  const Scene scene = cube_on_ground(600.0);
  const PatchMesh mesh = build_patches(scene);
  expect_consistent(mesh);
  EXPECT_EQ(hanging_vertices(mesh), 0);
  // Each addition rounds by 2^-53 of the sum so far, each area by a few times that of its own.
  // Elements share corners, so the area that the rounding of a corner adds to one element is taken
  // from another.
  double area = 0.0, rounding = 4.0 * 0x1p-53 * 3.6e5;
  for (int e = 0; e < mesh.element_count(); ++e) {
    if (mesh.facet[e] != 6 || mesh.is_back[mesh.patch[e]] != 0) continue;
    area += mesh.element_area[e];
    rounding += 0x1p-53 * area;
  }
  EXPECT_LT(rounding, 1e-12 * 3.6e5);
  EXPECT_NEAR(area, 3.6e5, rounding);
  const double near = cut_size(scene, {}).patch_size;
  for (int e = 0; e < mesh.element_count(); ++e) {
    if (mesh.facet[e] != 6) continue;
    Eigen::AlignedBox3d box;
    for (int c = 0; c < mesh.corner_count(e); ++c) box.extend(mesh.position(mesh.corners[e][c]));
    const Eigen::AlignedBox3d cube(Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(1, 1, 1));
    const double cell = std::max(near, 0.5 * std::sqrt(cube.squaredExteriorDistance(box.center())));
    EXPECT_LE(box.diagonal().norm(), 2.0 * 1.5 * 0.5 * std::sqrt(2.0) * cell) << box.center();
  }
}

// The ground of 6 km alone has 1600 patches, or up to twice as many where rounding to a power of
// two makes them shorter. Rings of 1 to 2, 2 to 4, ... 2048 to 4096 m, twelve on each side, add
// some 3 pi d^2 / (d / 4)^2 = 150 patches each, and twice as many at most.
TEST(Surroundings, AddFewPatchesHoweverLargeTheyAre) {
  constexpr int of_ground_alone = 2 * 1600, rings = 12, sides = 2, of_ring = 2 * 150;
  const int alone = build_patches(cube_on_ground(0.0)).patch_count();
  EXPECT_LT(build_patches(cube_on_ground(6000.0)).patch_count(),
            alone + of_ground_alone + rings * sides * of_ring);
}

TEST(Surroundings, ANoteSaysThatGivenPatchesAreTooCoarseForWhatTheySurround) {
  EXPECT_TRUE(build_patches(cube_on_ground(6000.0)).notes.empty());
  EXPECT_TRUE(build_patches(cube_on_ground(20.0), {.max_patch_size = 5.0}).notes.empty());
  const PatchMesh mesh = build_patches(cube_on_ground(6000.0), {.max_patch_size = 150.0});
  ASSERT_EQ(mesh.notes.size(), 1u);
  EXPECT_EQ(mesh.notes[0].find("the surroundings are 8485 m long"), 0u) << mesh.notes[0];
}

TEST(Surroundings, SceneryBoundsLeaveThemOut) {
  const Bounds near = scenery_bounds(build_patches(cube_on_ground(6000.0)));
  EXPECT_EQ(near.low, Eigen::Vector3d(0, 0, 0));
  EXPECT_EQ(near.high, Eigen::Vector3d(1, 1, 1));
  EXPECT_EQ(scenery_bounds(build_patches(cube_on_ground(20.0))).high, Eigen::Vector3d(10, 10, 1));
}

}  // namespace
}  // namespace lightwell::surroundings_test
