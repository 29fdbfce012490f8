#include "mesh/patches/sphere_grid.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <set>

#include "mesh/build_patches.h"
#include "tests/mesh/mesh_scenes.h"

namespace lightwell::sphere_grid_test {
namespace {

using namespace lightwell::test;
using Eigen::Vector3d;

PatchMesh sphere_mesh(double radius, double size, int k, int material = 0) {
  Scene scene = empty_scene();
  add_sphere(scene, "ball", {.center = {1, 2, 3}, .radius = radius}, material);
  return build_patches(scene, {.max_patch_size = size, .elements_per_patch_edge = k});
}

TEST(SphereGrid, AreasAddUpToFourPiR2) {
  for (const double radius : {0.1, 1.0, 7.0}) {
    for (const int k : {1, 2, 3}) {
      const PatchMesh mesh = sphere_mesh(radius, 0.6, k);
      expect_consistent(mesh);
      const double area = 4 * std::numbers::pi * radius * radius;
      EXPECT_NEAR(side_area(mesh, 0, false), area, 1e-12 * area);
      EXPECT_NEAR(side_area(mesh, 0, true), area, 1e-12 * area);
    }
  }
}

TEST(SphereGrid, OutsideAndInsideAreClosedSurfaces) {
  for (const int k : {1, 2, 5}) {
    const PatchMesh mesh = sphere_mesh(1.0, 0.5, k);
    // Two closed spheres: V - E + F = 2 each, and no edge has only one element.
    EXPECT_EQ(static_cast<int>(mesh.elements->n_vertices()) -
                  static_cast<int>(mesh.elements->n_edges()) +
                  static_cast<int>(mesh.elements->n_faces()),
              4);
    for (auto edge : mesh.elements->edges()) ASSERT_FALSE(mesh.elements->is_boundary(edge));
  }
}

TEST(SphereGrid, VerticesLieOnTheSphereWithRadialNormals) {
  const PatchMesh mesh = sphere_mesh(0.7, 0.3, 2);
  for (int e = 0; e < mesh.element_count(); ++e) {
    const double side = mesh.is_back[mesh.patch[e]] != 0 ? -1.0 : 1.0;
    for (int i = 0; i < mesh.corner_count(e); ++i) {
      const Vector3d d = mesh.position(mesh.corners[e][i]) - Vector3d(1, 2, 3);
      ASSERT_NEAR(d.norm(), 0.7, 1e-14);
      ASSERT_NEAR((mesh.vertex_normal[mesh.corners[e][i]] - side * d / 0.7).norm(), 0.0, 1e-12);
    }
  }
}

TEST(SphereGrid, EveryCellFindsItsElement) {
  const PatchMesh mesh = sphere_mesh(0.7, 0.3, 3);
  ASSERT_EQ(mesh.sphere_grids.size(), 1u);
  const SphereGrid& grid = mesh.sphere_grids.front();
  EXPECT_EQ(grid.facet, 0);
  std::set<int> all(grid.element.begin(), grid.element.end());
  EXPECT_EQ(static_cast<int>(all.size()), grid.rings * grid.sectors);
  for (int e : grid.element) {
    const PatchPoint center = element_center(mesh, e);
    EXPECT_EQ(mesh.is_back[mesh.patch[e]], 0);
    const SphereGridPoint grid_point =
        sphere_grid_point(grid, center.position - grid.sphere.center);
    EXPECT_EQ(grid.element[grid_point.ring * grid.sectors + grid_point.sector], e);
  }
}

TEST(SphereGrid, LastSectorClosesAtLongitudeZero) {
  const PatchMesh mesh = sphere_mesh(0.7, 0.3, 2);
  const SphereGrid& grid = mesh.sphere_grids.front();
  const double tiny = 1e-12;
  for (const double phi : {0.0, tiny, -tiny, -1e-300}) {
    const SphereGridPoint grid_point = sphere_grid_point(grid, {std::cos(phi), std::sin(phi), 0.1});
    EXPECT_TRUE(grid_point.sector == (phi < 0 ? grid.sectors - 1 : 0))
        << phi << " " << grid_point.sector;
    const Vector3d back = sphere_direction(grid, grid_point);
    EXPECT_NEAR(std::abs(std::atan2(back.y(), back.x())), 0.0, 1e-9);
  }
  for (const double z : {1.0, -1.0}) {
    const SphereGridPoint grid_point = sphere_grid_point(grid, {0, 0, z});
    EXPECT_EQ(grid_point.ring, z > 0 ? 0 : grid.rings - 1);
  }
}

TEST(SphereGrid, WeightsSumToOneAndMeetAtCellBorders) {
  const PatchMesh mesh = sphere_mesh(0.7, 0.3, 2);
  const SphereGrid& grid = mesh.sphere_grids.front();
  for (int ring = 0; ring < grid.rings; ++ring) {
    for (const double v : {0.0, 0.3, 1.0}) {
      const auto value = [&](int sector, double u) {
        const int e = grid.element[ring * grid.sectors + sector];
        const auto w = sphere_weights(grid, {ring, sector, u, v});
        EXPECT_NEAR(w.sum(), 1.0f, 1e-6f);
        Vector3d p = Vector3d::Zero();
        for (int i = 0; i < mesh.corner_count(e); ++i) {
          p += static_cast<double>(w[i]) * mesh.position(mesh.corners[e][i]);
        }
        return p;
      };
      // Weights are float, hence 1e-6.
      EXPECT_NEAR((value(0, 1.0) - value(1, 0.0)).norm(), 0.0, 1e-6);
      EXPECT_NEAR((value(grid.sectors - 1, 1.0) - value(0, 0.0)).norm(), 0.0, 1e-6);
    }
  }
}

TEST(SphereGrid, PatchesAreAboutAsLargeAsAsked) {
  const double size = 0.25;
  const PatchMesh mesh = sphere_mesh(1.0, size, 2, 1);
  // Sectors narrow towards the poles, where a patch spans more of them. Rounding down to whole
  // sectors of half a patch costs a third at most (2 of 2.99) and less on average. No patch is
  // wider than asked for.
  const double full = 4 * std::numbers::pi / (size * size);
  EXPECT_LT(mesh.patch_count(), 1.34 * full);
  EXPECT_LE(mesh.area.maxCoeff(), size * size);
}

TEST(SphereGrid, OneSidedSphereHasNoInside) {
  const PatchMesh mesh = sphere_mesh(1.0, 0.5, 2, 1);
  expect_consistent(mesh);
  EXPECT_EQ(side_area(mesh, 0, true), 0.0);
  for (int t : mesh.twin) EXPECT_EQ(t, -1);
}

}  // namespace
}  // namespace lightwell::sphere_grid_test
