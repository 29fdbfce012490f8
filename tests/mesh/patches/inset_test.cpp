#include "mesh/patches/inset.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "mesh/build_patches.h"
#include "tests/mesh/mesh_scenes.h"

namespace lightwell::inset_test {
namespace {

using namespace lightwell::test;
using Eigen::Vector3d;

// The centre of an oblong of 4 m x 1 m is 0.5 m off its longer sides.
TEST(Inset, IsAShareOfTheWayButNotLessThanTheLeast) {
  Scene scene = empty_scene();
  add_polygon(scene, "oblong", {{0, 0, 0}, {4, 0, 0}, {4, 1, 0}, {0, 1, 0}}, {}, 1);
  PatchMesh mesh = build_patches(scene, {.max_patch_size = 8.0, .elements_per_patch_edge = 1});
  ASSERT_EQ(mesh.element_count(), 1);
  for (const auto& [least, share] : {std::pair(0.005, 0.02), {0.05, 0.1}, {3.0, 0.5}}) {
    mesh.least_inset = least;
    EXPECT_DOUBLE_EQ(inset_share(mesh, 0, 0.02), share);
  }
}

// The centre of a triangle is a third of each height off the side below.
TEST(Inset, KeepsPointsOfNeedlesOffTheirBorders) {
  constexpr double width = 1e-3, least = 1e-5;
  Scene scene = empty_scene();
  add_polygon(scene, "needle", {{0, 0, 0}, {1, 0, 0}, {0.5, width, 0}}, {}, 1);
  PatchMesh mesh = build_patches(scene, {.max_patch_size = 8.0, .elements_per_patch_edge = 1});
  ASSERT_EQ(mesh.element_count(), 1);
  mesh.least_inset = least;
  const Vector3d center = element_center(mesh, 0).position;
  const double share = inset_share(mesh, 0, 1e-6);
  EXPECT_LT(share, 0.5);
  for (int v = 0; v < mesh.vertex_count(); ++v) {
    const Vector3d p = mesh.position(v) + share * (center - mesh.position(v));
    const double to_sides = width * (1.0 - 2.0 * std::abs(p.x() - 0.5)) - p.y();
    EXPECT_GT(std::min(p.y(), to_sides), least) << v;
  }
}

// Single precision has 24 bits, so a coordinate h is rounded by up to h 2^-24, half of epsilon().
TEST(Inset, LeastIsBeyondTheRoundingOfTheMesh) {
  for (const double scale : {1e-3, 1.0, 1e4}) {
    Scene scene = empty_scene();
    add_polygon(scene, "floor",
                {{0, 0, 0}, {3 * scale, 0, 0}, {3 * scale, 4 * scale, 0}, {0, 4 * scale, 0}});
    const double least = build_patches(scene, {.max_patch_size = scale}).least_inset;
    const double rounding = 2.5 * scale * 0x1p-24;
    EXPECT_DOUBLE_EQ(least, 32.0 * rounding);
  }
}

}  // namespace
}  // namespace lightwell::inset_test
