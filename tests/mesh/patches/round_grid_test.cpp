#include "mesh/patches/round_grid.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <set>

#include "mesh/build_patches.h"
#include "tests/mesh/mesh_scenes.h"

namespace lightwell::round_grid_test {
namespace {

using namespace lightwell::test;
using Eigen::Vector3d;

PatchMesh sphere_mesh(double radius, double size, int k, int material = 0) {
  Scene scene = empty_scene();
  add_sphere(scene, "ball", {.center = {1, 2, 3}, .radius = radius}, material);
  return build_patches(scene, {.max_patch_size = size, .elements_per_patch_edge = k});
}

TEST(RoundGrid, AreasAddUpToFourPiR2) {
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

TEST(RoundGrid, OutsideAndInsideAreClosedSurfaces) {
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

TEST(RoundGrid, VerticesLieOnTheSphereWithRadialNormals) {
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

TEST(RoundGrid, EveryCellFindsItsElement) {
  const PatchMesh mesh = sphere_mesh(0.7, 0.3, 3);
  ASSERT_EQ(mesh.round_grids.size(), 1u);
  const RoundGrid& grid = mesh.round_grids.front();
  EXPECT_EQ(grid.facet, 0);
  std::set<int> all(grid.element.begin(), grid.element.end());
  EXPECT_EQ(static_cast<int>(all.size()), grid.rings * grid.sectors);
  for (int e : grid.element) {
    const PatchPoint center = element_center(mesh, e);
    EXPECT_EQ(mesh.is_back[mesh.patch[e]], 0);
    const RoundGridPoint grid_point = round_grid_point(grid, center.position);
    EXPECT_EQ(grid.element[grid_point.ring * grid.sectors + grid_point.sector], e);
  }
}

TEST(RoundGrid, LastSectorClosesAtLongitudeZero) {
  const PatchMesh mesh = sphere_mesh(0.7, 0.3, 2);
  RoundGrid grid = mesh.round_grids.front();
  grid.shape = Sphere{.radius = 0.7};
  const double tiny = 1e-12;
  for (const double phi : {0.0, tiny, -tiny, -1e-300}) {
    const RoundGridPoint grid_point = round_grid_point(grid, {std::cos(phi), std::sin(phi), 0.1});
    EXPECT_TRUE(grid_point.sector == (phi < 0 ? grid.sectors - 1 : 0))
        << phi << " " << grid_point.sector;
    const Vector3d back = point_at(grid, grid_point);
    EXPECT_NEAR(std::abs(std::atan2(back.y(), back.x())), 0.0, 1e-9);
  }
  for (const double z : {1.0, -1.0}) {
    const RoundGridPoint grid_point = round_grid_point(grid, {0, 0, z});
    EXPECT_EQ(grid_point.ring, z > 0 ? 0 : grid.rings - 1);
  }
}

TEST(RoundGrid, WeightsSumToOneAndMeetAtCellBorders) {
  const PatchMesh mesh = sphere_mesh(0.7, 0.3, 2);
  const RoundGrid& grid = mesh.round_grids.front();
  for (int ring = 0; ring < grid.rings; ++ring) {
    for (const double v : {0.0, 0.3, 1.0}) {
      const auto value = [&](int sector, double u) {
        const int e = grid.element[ring * grid.sectors + sector];
        const auto w = round_weights(grid, {ring, sector, u, v});
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

TEST(RoundGrid, PatchesAreAboutAsLargeAsAsked) {
  const double size = 0.25;
  const PatchMesh mesh = sphere_mesh(1.0, size, 2, 1);
  // Sectors narrow towards the poles, where a patch spans more of them. Rounding down to whole
  // sectors of half a patch costs a third at most (2 of 2.99) and less on average. No patch is
  // wider than asked for.
  const double full = 4 * std::numbers::pi / (size * size);
  EXPECT_LT(mesh.patch_count(), 1.34 * full);
  EXPECT_LE(mesh.area.maxCoeff(), size * size);
}

TEST(RoundGrid, OneSidedSphereHasNoInside) {
  const PatchMesh mesh = sphere_mesh(1.0, 0.5, 2, 1);
  expect_consistent(mesh);
  EXPECT_EQ(side_area(mesh, 0, true), 0.0);
  for (int t : mesh.twin) EXPECT_EQ(t, -1);
}

std::vector<Frustum> frustums() {
  const Vector3d axis = Vector3d(1, -2, 2) / 3.0;
  std::vector<Frustum> all;
  for (const bool inward : {false, true}) {
    for (const double height : {0.0, 0.8}) {
      for (const double top : {0.0, 0.25, 0.9}) {
        all.push_back({.base = {1, 2, 3},
                       .axis = axis,
                       .height = height,
                       .base_radius = 0.5,
                       .top_radius = top,
                       .inward = inward});
      }
    }
  }
  all.push_back({.height = 0.5, .base_radius = 0.0, .top_radius = 1.0});
  all.push_back({.height = 2.0, .base_radius = 0.3, .top_radius = 0.3});
  return all;
}

PatchMesh mesh_of(const Frustum& frustum, double size) {
  Scene scene = empty_scene();
  scene.surfaces.push_back({.name = "frustum", .shape = frustum});
  return build_patches(scene, {.max_patch_size = size, .elements_per_patch_edge = 2});
}

TEST(RoundGrid, FrustumsKeepTheirAreaAndTheirFront) {
  for (const Frustum& frustum : frustums()) {
    for (const double size : {0.15, 1.0}) {
      const PatchMesh mesh = mesh_of(frustum, size);
      expect_consistent(mesh);
      EXPECT_NEAR(side_area(mesh, 0, false), area(frustum), 1e-12);
      EXPECT_NEAR(side_area(mesh, 0, true), area(frustum), 1e-12);
      const RoundGrid& grid = mesh.round_grids.front();
      for (const int e : grid.element) {
        const PatchPoint center = element_center(mesh, e);
        EXPECT_NEAR((nearest_on(frustum, center.position) - center.position).norm(), 0.0, 1e-14);
        EXPECT_NEAR((front_normal(frustum, center.position) - center.normal).norm(), 0.0, 1e-14);
        // The corners run counter-clockwise as seen from the front.
        const auto& c = mesh.corners[e];
        const Vector3d p = mesh.position(c[0]);
        EXPECT_GT((mesh.position(c[1]) - p).cross(mesh.position(c[2]) - p).dot(center.normal), 0.0);
        const RoundGridPoint place = round_grid_point(grid, center.position);
        EXPECT_EQ(grid.element[place.ring * grid.sectors + place.sector], e);
      }
    }
  }
}

TEST(RoundGrid, PlacesOnFrustumsGoThereAndBack) {
  for (const Frustum& frustum : frustums()) {
    const PatchMesh mesh = mesh_of(frustum, 0.3);
    const RoundGrid& grid = mesh.round_grids.front();
    for (int ring = 0; ring < grid.rings; ++ring) {
      const RoundGridPoint place{ring, 3, 0.3, 0.4};
      const Vector3d at = point_at(grid, place);
      EXPECT_NEAR((nearest_on(frustum, at) - at).norm(), 0.0, 1e-14);
      const RoundGridPoint back = round_grid_point(grid, at);
      EXPECT_EQ(back.ring, ring);
      EXPECT_EQ(back.sector, 3);
      EXPECT_NEAR(back.u, 0.3, 1e-12);
      EXPECT_NEAR(back.v, 0.4, 1e-12);
      EXPECT_NEAR(round_weights(grid, place).sum(), 1.0f, 1e-6f);
    }
  }
}

/// Of points at even shares of a cell's area, half lie on either side of the parallel that halves
/// the area.
TEST(RoundGrid, EvenPointsAreEvenInArea) {
  for (const Frustum& frustum : frustums()) {
    const PatchMesh mesh = mesh_of(frustum, 3.0);
    const RoundGrid& grid = mesh.round_grids.front();
    const RoundGridPoint half = round_grid_point(grid, even_point(grid, 0, 0, 0.5, 0.5));
    EXPECT_NEAR(half.u, 0.5, 1e-9);
    const auto radius = [&](const RoundGridPoint& place) {
      return radius_at(frustum, 1.0 - (place.ring + 1.0 - place.v) / grid.rings);
    };
    const double low = radius({0, 0, 0.5, 0.0}), high = radius({0, 0, 0.5, 1.0});
    // Areas of the two parts, up to the same factor: (r_0 + r_1) times the share of the way.
    const double below = (low + radius(half)) * half.v;
    const double above = (radius(half) + high) * (1.0 - half.v);
    EXPECT_NEAR(below, above, 1e-12 * (below + above));
  }
}

}  // namespace
}  // namespace lightwell::round_grid_test
