#include "mesh/cleaning/mesh_quality.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "scene/io/placed_mesh.h"

namespace lightwell::mesh_quality_test {
namespace {

Scene scene_of(const std::vector<Loop>& loops) {
  Repairs repairs;
  Scene scene;
  scene.surfaces.push_back(
      {.name = "it", .shape = placed_loops(loops, Eigen::Affine3d::Identity(), false, repairs)});
  return scene;
}

TEST(MeshQuality, ACubeHasTwelveTrianglesAndNoFault) {
  const MeshQuality quality = mesh_quality(scene_of(cube_loops()));
  EXPECT_EQ(quality.triangles, 12);
  EXPECT_EQ(quality.slivers, 0);
  EXPECT_EQ(quality.open_edges, 0);
  EXPECT_EQ(quality.non_manifold_edges, 0);
  EXPECT_EQ(quality.inconsistent_edges, 0);
}

TEST(MeshQuality, WithoutALidFourEdgesAreOpenAndAReversedFaceDisagreesAlongFour) {
  std::vector<Loop> loops = cube_loops();
  std::reverse(loops[0].begin(), loops[0].end());
  EXPECT_EQ(mesh_quality(scene_of(loops)).inconsistent_edges, 4);
  loops.erase(loops.begin());
  const MeshQuality open = mesh_quality(scene_of(loops));
  EXPECT_EQ(open.open_edges, 4);
  EXPECT_EQ(open.inconsistent_edges, 0);
}

TEST(MeshQuality, ThreeWingsOnOneEdgeAreNoManifold) {
  const Eigen::Vector3d a(0, 0, 0), b(0, 0, 1);
  const MeshQuality quality =
      mesh_quality(scene_of({{a, b, {1, 0, 0}}, {a, b, {0, 1, 0}}, {b, a, {-1, -1, 0}}}));
  EXPECT_EQ(quality.non_manifold_edges, 1);
  EXPECT_EQ(quality.inconsistent_edges, 1);  // two of the three polygons pass the edge from a to b
  EXPECT_EQ(quality.open_edges, 6);
}

TEST(MeshQuality, EdgesOfTwoSurfacesAreTwoBoundaries) {
  Scene scene = scene_of(rectangle_loops());
  scene.surfaces.push_back(scene_of({{{1, -1, 0}, {3, -1, 0}, {3, 1, 0}, {1, 1, 0}}}).surfaces[0]);
  EXPECT_EQ(mesh_quality(scene).open_edges, 8);
}

TEST(MeshQuality, SliversAreNarrowerThanAHundredthOfTheirLength) {
  const auto slivers = [](double height) {
    return mesh_quality(scene_of({{{0, 0, 0}, {1, 0, 0}, {0.3, height, 0}}})).slivers;
  };
  EXPECT_EQ(slivers(0.0101), 0);
  EXPECT_EQ(slivers(0.0099), 1);
  const auto strips = [](double width) {
    return mesh_quality(scene_of({{{0, 0, 0}, {1, 0, 0}, {1, width, 0}, {0, width, 0}}})).slivers;
  };
  EXPECT_EQ(strips(0.0102), 0);  // the length of a strip is its diagonal
  EXPECT_EQ(strips(0.0099), 1);
}

TEST(MeshQuality, HolesAddTriangles) {
  PolygonMesh mesh;
  mesh.vertices = {{0, 0, 0}, {3, 0, 0}, {3, 3, 0}, {0, 3, 0},
                   {1, 1, 0}, {1, 2, 0}, {2, 2, 0}, {2, 1, 0}};
  mesh.facets.push_back({.boundary = {0, 1, 2, 3}, .holes = {{4, 5, 6, 7}}});
  Scene scene;
  scene.surfaces.push_back({.name = "frame", .shape = mesh});
  EXPECT_EQ(mesh_quality(scene).triangles, 8);  // an annulus with 4 outer and 4 inner corners
}

}  // namespace
}  // namespace lightwell::mesh_quality_test
