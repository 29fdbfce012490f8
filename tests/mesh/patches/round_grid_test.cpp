#include "mesh/patches/round_grid.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <set>

#include "mesh/build_patches.h"
#include "tests/mesh/mesh_scenes.h"

namespace lightwell::round_grid_test {
namespace {

using namespace lightwell::test;
using Eigen::Vector3d;

// Six roundings of a place on its way there and six on its way back, of coordinates below 4 m.
constexpr double place_rounding = 12 * 0x1p-53 * 4.0;  // 5.3e-15 m

// Two factors, their product and three sums of float weights up to 1, each rounded by half of
// epsilon.
constexpr float weight_rounding = 3 * std::numeric_limits<float>::epsilon();

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
      // Elements of one ring have the same area, and its addition is rounded alike, by up to 2^-53
      // of the sum. Rings are rounded independently: twice this is 3.5 standard errors.
      const RoundGrid& grid = mesh.round_grids.front();
      const double rounding = 2.0 * grid.sectors * std::sqrt(grid.rings) * 0x1p-53;
      EXPECT_LT(rounding, 1e-12);
      EXPECT_NEAR(side_area(mesh, 0, false), area, rounding * area);
      EXPECT_NEAR(side_area(mesh, 0, true), area, rounding * area);
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
      ASSERT_NEAR(d.norm(), 0.7, place_rounding);
      // A place that is off turns its normal by the share of the radius.
      ASSERT_NEAR((mesh.vertex_normal[mesh.corners[e][i]] - side * d / 0.7).norm(), 0.0,
                  place_rounding / 0.7);
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
  // Eight roundings of longitudes up to 2 pi.
  constexpr double rounding = 8 * 0x1p-53 * 2.0 * std::numbers::pi;
  for (const double phi : {0.0, tiny, -tiny, -1e-300}) {
    const RoundGridPoint grid_point = round_grid_point(grid, {std::cos(phi), std::sin(phi), 0.1});
    EXPECT_TRUE(grid_point.sector == (phi < 0 ? grid.sectors - 1 : 0))
        << phi << " " << grid_point.sector;
    const Vector3d back = point_at(grid, grid_point);
    EXPECT_NEAR(std::abs(std::atan2(back.y(), back.x())), 0.0, tiny + rounding);
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
        EXPECT_NEAR(w.sum(), 1.0f, weight_rounding);
        Vector3d p = Vector3d::Zero();
        for (int i = 0; i < mesh.corner_count(e); ++i) {
          p += static_cast<double>(w[i]) * mesh.position(mesh.corners[e][i]);
        }
        return p;
      };
      // Weights at a border are the same floats in both cells. Three sums in either, of places up
      // to sqrt(14) + 0.7 = 4.45 m away, have another order.
      constexpr double rounding = 6 * 0x1p-53 * 4.45;
      EXPECT_NEAR((value(0, 1.0) - value(1, 0.0)).norm(), 0.0, rounding);
      EXPECT_NEAR((value(grid.sectors - 1, 1.0) - value(0, 0.0)).norm(), 0.0, rounding);
    }
  }
}

TEST(RoundGrid, PatchesAreAboutAsLargeAsAsked) {
  const double size = 0.25;
  const PatchMesh mesh = sphere_mesh(1.0, size, 2, 1);
  // Sectors narrow towards the poles, where a patch spans more of them. No patch is wider than
  // asked for. Where x sectors fit, a patch takes floor(x) of them: x / floor(x) is 1.12 in the
  // mean over the sphere. Rows are 13 instead of 12.6, a factor of 1.035, and are cut for their
  // widest parallel, 1 + pi / 26 of the mean. Half a column more in each adds 6.5 of 201 patches.
  // All of this makes 1.34.
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
      const RoundGrid& grid = mesh.round_grids.front();
      // A sum of as many areas as there are elements, each the product of six factors.
      const double rounding =
          (static_cast<double>(grid.element.size()) + 6.0) * 0x1p-53 * area(frustum);
      EXPECT_LT(rounding, 1e-12);
      EXPECT_NEAR(side_area(mesh, 0, false), area(frustum), rounding);
      EXPECT_NEAR(side_area(mesh, 0, true), area(frustum), rounding);
      for (const int e : grid.element) {
        const PatchPoint center = element_center(mesh, e);
        EXPECT_NEAR((nearest_on(frustum, center.position) - center.position).norm(), 0.0,
                    place_rounding);
        EXPECT_EQ(front_normal(frustum, center.position), center.normal);
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
      EXPECT_NEAR((nearest_on(frustum, at) - at).norm(), 0.0, place_rounding);
      const RoundGridPoint back = round_grid_point(grid, at);
      EXPECT_EQ(back.ring, ring);
      EXPECT_EQ(back.sector, 3);
      // A cell of n sectors is 2 pi r / n wide, one of m rings slant / m high.
      const double r = radius_at(frustum, 1.0 - (ring + 0.6) / grid.rings);
      const double across = place_rounding * grid.sectors / (2.0 * std::numbers::pi * r);
      const double along = place_rounding * grid.rings / slant_height(frustum);
      EXPECT_LT(std::max(across, along), 1e-12);
      EXPECT_NEAR(back.u, 0.3, across);
      EXPECT_NEAR(back.v, 0.4, along);
      EXPECT_NEAR(round_weights(grid, place).sum(), 1.0f, weight_rounding);
    }
  }
}

/// Points at even shares of a cell's area lie by halves on either side of the parallel that halves
/// the area.
TEST(RoundGrid, EvenPointsAreEvenInArea) {
  for (const Frustum& frustum : frustums()) {
    const PatchMesh mesh = mesh_of(frustum, 3.0);
    const RoundGrid& grid = mesh.round_grids.front();
    const RoundGridPoint half = round_grid_point(grid, even_point(grid, 0, 0, 0.5, 0.5));
    const auto radius = [&](const RoundGridPoint& place) {
      return radius_at(frustum, 1.0 - (place.ring + 1.0 - place.v) / grid.rings);
    };
    const double low = radius({0, 0, 0.5, 0.0}), high = radius({0, 0, 0.5, 1.0});
    // Areas of the two parts, up to the same factor: (r_0 + r_1) times the share of the way.
    const double r = radius(half);
    const double below = (low + r) * half.v;
    const double above = (r + high) * (1.0 - half.v);
    // A cell is 2 pi r / sectors wide and as high as the slant. Areas below and above change by the
    // sums of their radii, at most four times the widest, while v runs from 0 to 1.
    const double across = place_rounding * grid.sectors / (2.0 * std::numbers::pi * r);
    EXPECT_NEAR(half.u, 0.5, across);
    const double along = place_rounding / slant_height(frustum);
    const double rounding = 4.0 * std::max(low, high) * along;
    EXPECT_LT(rounding, 1e-12 * (below + above));
    EXPECT_NEAR(below, above, rounding);
  }
}

}  // namespace
}  // namespace lightwell::round_grid_test
