#include "mesh/facets/group_facets.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "mesh/build_patches.h"
#include "mesh/patches/patch_mesh.h"
#include "mesh/patches/patch_outline.h"
#include "mesh/patches/patch_sampler.h"
#include "tests/mesh/mesh_scenes.h"

namespace lightwell::group_facets_test {
namespace {

using namespace lightwell::test;
using Eigen::Vector3d;

Vector3d mean_normal(const PatchMesh& mesh, int patch) {
  Vector3d sum = Vector3d::Zero();
  for (int e = mesh.first_element[patch]; e < mesh.first_element[patch + 1]; ++e) {
    sum += mesh.element_area[e] * element_center(mesh, e).normal;
  }
  return sum.normalized();
}

double polygon_area(const Scene& scene) {
  double area = 0.0;
  for (const Surface& surface : scene.surfaces) {
    const auto& mesh = std::get<PolygonMesh>(surface.shape);
    for (const Facet& facet : mesh.facets) area += facet_area(mesh, facet);
  }
  return area;
}

TEST(GroupFacets, BallHasAsManyPatchesAsItsAreaAsksFor) {
  const Scene scene = triangle_ball(64, 1);
  const double area = polygon_area(scene);
  for (const double size : {0.2, 0.3, 0.4}) {
    const PatchMesh mesh = build_patches(scene, {.max_patch_size = size});
    expect_consistent(mesh);
    EXPECT_NEAR(mesh.area.sum(), area, 1e-12 * area);
    // A patch has at least 15 % of a full one, unless no neighbour has room, and at most 1.2 of
    // one.
    const double full = area / (size * size);
    EXPECT_GT(mesh.patch_count(), full / 1.2);
    EXPECT_LT(mesh.patch_count(), 2.0 * full);
    for (int p = 0; p < mesh.patch_count(); ++p) EXPECT_LE(mesh.area[p], 1.2 * size * size);
  }
}

double largest_angle_from_mean(const PatchMesh& mesh) {
  double largest = 0.0;
  for (int p = 0; p < mesh.patch_count(); ++p) {
    const Vector3d mean = mean_normal(mesh, p);
    for (int e = mesh.first_element[p]; e < mesh.first_element[p + 1]; ++e) {
      const Vector3d normal = element_center(mesh, e).normal;
      largest = std::max(largest, std::atan2(mean.cross(normal).norm(), mean.dot(normal)));
    }
  }
  return largest * 180.0 / M_PI;
}

constexpr double rounding = 1e-9;  // degrees

TEST(GroupFacets, NormalsStayWithinTheAngleOfThePatchsMean) {
  const PatchMesh mesh = build_patches(triangle_ball(64, 1), {.max_patch_size = 1.0});
  EXPECT_LE(largest_angle_from_mean(mesh), 20.0 + rounding);
  EXPECT_LT(mesh.patch_count(), 2 * 59);  // a cap of 15 degrees is 1/59 of the ball
}

// Leaves that face in all directions, in one cell.
TEST(GroupFacets, CrumbsStayWithinTheAngleToo) {
  std::mt19937 random(7);
  std::normal_distribution<double> normal;
  const auto direction = [&] {
    return Vector3d(normal(random), normal(random), normal(random)).normalized();
  };
  PolygonMesh leaves;
  constexpr int n = 3000;
  for (int i = 0; i < n; ++i) {
    const Vector3d at = 0.4 * direction(), u = direction(), v = u.cross(direction());
    const int first = static_cast<int>(leaves.vertices.size());
    for (const Vector3d& d : {Vector3d(0, 0, 0), u, v}) leaves.vertices.push_back(at + 1e-3 * d);
    leaves.facets.push_back({.boundary = {first, first + 1, first + 2}});
  }
  Scene scene = empty_scene();
  scene.surfaces.push_back({.name = "leaves", .material = 1, .shape = leaves});
  for (const double angle : {5.0, 20.0, 45.0}) {
    const PatchMesh mesh =
        build_patches(scene, {.max_patch_size = 1.0, .curve_angle_degrees = angle});
    EXPECT_LE(largest_angle_from_mean(mesh), angle + rounding);
    // Seeds are at least the angle apart, so caps of half the angle about them do not overlap.
    const double caps = 2.0 / (1.0 - std::cos(0.5 * angle * M_PI / 180.0));
    EXPECT_LT(mesh.patch_count(), caps);
  }
}

TEST(GroupFacets, BothSidesArePatchedAlike) {
  const PatchMesh mesh = build_patches(triangle_ball(24, 0), {.max_patch_size = 0.5});
  expect_consistent(mesh);
  for (int e = 0; e < mesh.element_count(); ++e) {
    const int other = mesh.twin[e];
    ASSERT_GE(other, 0);
    EXPECT_EQ(mesh.facet[other], mesh.facet[e]);
    EXPECT_NE(mesh.is_back[mesh.patch[other]], mesh.is_back[mesh.patch[e]]);
    EXPECT_EQ(mesh.area[mesh.patch[other]], mesh.area[mesh.patch[e]]);
  }
}

TEST(GroupFacets, DoNotDependOnTheUnit) {
  Scene scene = triangle_ball(24, 1);
  const PatchMesh metres = build_patches(scene, {.max_patch_size = 0.5});
  for (Vector3d& v : std::get<PolygonMesh>(scene.surfaces[0].shape).vertices) v *= 1024.0;
  EXPECT_EQ(build_patches(scene, {.max_patch_size = 512.0}).patch, metres.patch);
}

TEST(GroupFacets, SharpEdgesAndLargeFacetsKeepPatchesApart) {
  Scene scene = empty_scene();
  add_box(scene, "box", {0, 0, 0}, {0.4, 0.4, 0.4});
  const PatchMesh mesh = build_patches(scene, {.max_patch_size = 1.0});
  EXPECT_EQ(mesh.patch_count(), 2 * 6);
  for (int p = 0; p < mesh.patch_count(); ++p) {
    EXPECT_GE(mesh.facet_of(p), 0);
    EXPECT_TRUE(patch_outline(mesh, p).is_polygon());
  }
}

TEST(GroupFacets, EmittersAndZeroDegreesKeepToFacets) {
  Scene scene = triangle_ball(16, 1);
  const int facets = static_cast<int>(scene_facets(scene).size());
  const PatchMesh apart = build_patches(scene, {.max_patch_size = 1.0, .curve_angle_degrees = 0.0});
  EXPECT_EQ(apart.patch_count(), facets);
  EXPECT_LT(build_patches(scene, {.max_patch_size = 1.0}).patch_count(), facets);
  scene.materials[1].emission = Spectrum::Constant(3, 1.0f);
  EXPECT_EQ(build_patches(scene, {.max_patch_size = 1.0}).patch_count(), facets);
}

// A thousand crumbs far from each other's edges, all facing up, over a square of four cells.
TEST(GroupFacets, UnconnectedCrumbsOfOnePlaceAndDirectionShareAPatch) {
  PolygonMesh crumbs;
  for (int i = 0; i < 1000; ++i) {
    const double x = 0.05 + 1.9 * (i % 40) / 40, y = 0.05 + 1.9 * (i / 40) / 25.0;
    const int first = static_cast<int>(crumbs.vertices.size());
    for (const Vector3d& d : {Vector3d(0, 0, 0), Vector3d(0.01, 0, 0), Vector3d(0, 0.01, 0)}) {
      crumbs.vertices.push_back(Vector3d(x, y, 1e-3 * (i % 7)) + d);
    }
    crumbs.facets.push_back({.boundary = {first, first + 1, first + 2}});
  }
  Scene scene = empty_scene();
  scene.surfaces.push_back({.name = "crumbs", .material = 1, .shape = crumbs});
  const PatchMesh mesh = build_patches(scene, {.max_patch_size = 1.0});
  expect_consistent(mesh);
  EXPECT_EQ(mesh.patch_count(), 4);
  EXPECT_EQ(mesh.element_count(), 1000);
}

// The number of n points that lie on an element is n A_e / A within 5 standard deviations of a
// binomial.
TEST(GroupFacets, SamplesAreEvenOverAPatchOfManyFacets) {
  const PatchMesh mesh = build_patches(triangle_ball(24, 1), {.max_patch_size = 0.7});
  int patch = 0;
  mesh.area.maxCoeff(&patch);
  ASSERT_LT(mesh.facet_of(patch), 0);
  EXPECT_FALSE(patch_outline(mesh, patch).is_polygon());
  const PatchSampler sampler(mesh, patch);
  EXPECT_FALSE(sampler.is_flat());
  constexpr int n = 1 << 16;
  std::vector<int> count(mesh.element_count(), 0);
  std::mt19937 random(4);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  for (int i = 0; i < n; ++i) {
    const double u = uniform(random), v = uniform(random);
    const PatchPoint point = sampler.point(u, v);
    ASSERT_EQ(mesh.patch[point.element], patch);
    EXPECT_NEAR(point.normal.dot(element_center(mesh, point.element).normal), 1.0, 1e-12);
    ++count[point.element];
  }
  for (int e = mesh.first_element[patch]; e < mesh.first_element[patch + 1]; ++e) {
    const double share = mesh.element_area[e] / mesh.area[patch];
    EXPECT_NEAR(count[e], share * n, 5.0 * std::sqrt(share * (1.0 - share) * n));
  }
}

}  // namespace
}  // namespace lightwell::group_facets_test
