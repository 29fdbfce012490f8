// A small scene amid a ground or a dome of kilometres.
#include <gtest/gtest.h>

#include "mesh/build_patches.h"
#include "mesh/patches/mesh_bounds.h"
#include "tests/mesh/mesh_scenes.h"

namespace lightwell::surroundings_test {
namespace {

using namespace lightwell::test;

// A cube of 1 m on a ground of the given length.
PatchMesh cube_on_ground(double length) {
  Scene scene = empty_scene();
  for (const double z : {0.0, 1.0}) {
    add_polygon(scene, "level", {{0, 0, z}, {1, 0, z}, {1, 1, z}, {0, 1, z}});
    add_polygon(scene, "wall", {{0, z, 0}, {1, z, 0}, {1, z, 1}, {0, z, 1}});
    add_polygon(scene, "side", {{z, 0, 0}, {z, 1, 0}, {z, 1, 1}, {z, 0, 1}});
  }
  const double h = 0.5 * length;
  add_polygon(scene, "ground", {{-h, -h, 0}, {h, -h, 0}, {h, h, 0}, {-h, h, 0}});
  return build_patches(scene);
}

TEST(Surroundings, ANoteSaysThatPatchesAreTooCoarseForWhatTheySurround) {
  EXPECT_TRUE(cube_on_ground(20.0).notes.empty());
  const PatchMesh mesh = cube_on_ground(6000.0);
  ASSERT_EQ(mesh.notes.size(), 1u);
  EXPECT_EQ(mesh.notes[0].find("the surroundings are 8485 m long"), 0u) << mesh.notes[0];
}

TEST(Surroundings, SceneryBoundsLeaveThemOut) {
  const Bounds near = scenery_bounds(cube_on_ground(6000.0));
  EXPECT_EQ(near.low, Eigen::Vector3d(0, 0, 0));
  EXPECT_EQ(near.high, Eigen::Vector3d(1, 1, 1));
  EXPECT_EQ(scenery_bounds(cube_on_ground(20.0)).high, Eigen::Vector3d(10, 10, 1));
}

}  // namespace
}  // namespace lightwell::surroundings_test
