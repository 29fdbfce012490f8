#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "mesh/build_patches.h"
#include "mesh/patches/patch_mesh.h"
#include "mesh/patches/patch_sampler.h"
#include "tests/mesh/mesh_scenes.h"

namespace lightwell::patch_geometry_test {
namespace {

using namespace lightwell::test;
using Eigen::Vector3d;

// The midpoints of an n x n division of the unit square.
template <class Visit>
void for_each_sample(int n, Visit&& visit) {
  for (int j = 0; j < n; ++j) {
    for (int i = 0; i < n; ++i) visit((i + 0.5) / n, (j + 0.5) / n);
  }
}

// Two triangles with a common edge, the first of which is a needle.
TEST(VertexElements, AreNoNeedles) {
  for (const double width : {0.5, 1e-5}) {
    Scene scene = empty_scene();
    const PolygonMesh sheet{.vertices = {{0, 0, 0}, {width, 0, 0}, {0, 1, 0}, {-1, 0, 0}},
                            .facets = {Facet{.boundary = {0, 1, 2}}, Facet{.boundary = {0, 2, 3}}}};
    scene.surfaces.push_back({.name = "sheet", .material = 1, .shape = sheet});
    PatchMesh mesh = build_patches(scene, {.max_patch_size = 4.0, .elements_per_patch_edge = 1});
    ASSERT_EQ(mesh.element_count(), 2);
    std::vector<Eigen::Vector3d> positions;
    for (int v = 0; v < mesh.vertex_count(); ++v) positions.push_back(mesh.position(v));
    const std::vector<int> elements = vertex_elements(mesh);
    int shared = 0;
    for (int v = 0; v < mesh.vertex_count(); ++v) {
      if (positions[v].x() != 0.0) continue;
      ++shared;
      EXPECT_EQ(elements[v], width == 0.5 ? 0 : 1) << width;
    }
    EXPECT_EQ(shared, 2) << "the vertices of the common edge";
  }
}

TEST(PatchSampler, IsUniformByAreaOnAnyPatch) {
  Scene scene = empty_scene();
  add_polygon(scene, "kite", {{0, 0, 1}, {2, 0.3, 1}, {2.5, 2, 1}, {0.2, 1.1, 1}}, {}, 1);
  add_polygon(scene, "triangle", {{5, 0, 0}, {7, 0.3, 0.5}, {5.5, 2, 1}}, {}, 1);
  const PatchMesh mesh =
      build_patches(scene, {.max_patch_size = 1.0, .elements_per_patch_edge = 3});
  const int n = 200;
  for (int p = 0; p < mesh.patch_count(); ++p) {
    // The exact centroid of the patch, from its elements split into triangles.
    Vector3d centroid = Vector3d::Zero();
    for (int e = mesh.first_element[p]; e < mesh.first_element[p + 1]; ++e) {
      const auto& c = mesh.corners[e];
      for (int i = 1; i + 1 < mesh.corner_count(e); ++i) {
        const Vector3d a = mesh.position(c[0]), b = mesh.position(c[i]),
                       d = mesh.position(c[i + 1]);
        centroid += 0.5 * (b - a).cross(d - a).norm() * (a + b + d) / 3.0;
      }
    }
    centroid /= mesh.area[p];
    Vector3d mean = Vector3d::Zero();
    std::vector<double> share(mesh.element_count(), 0.0);
    const PatchSampler sampler(mesh, p);
    for_each_sample(n, [&](double u, double v) {
      const PatchPoint point = sampler.point(u, v);
      ASSERT_EQ(mesh.patch[point.element], p);
      share[point.element] += 1.0 / (n * n);
      mean += point.position / (n * n);
    });
    // Error of a midpoint rule of n strips: 1/n of the extent (1 m) at the jumps from element to
    // element.
    EXPECT_NEAR((mean - centroid).norm(), 0.0, 1.0 / n);
    for (int e = mesh.first_element[p]; e < mesh.first_element[p + 1]; ++e) {
      EXPECT_NEAR(share[e], mesh.element_area[e] / mesh.area[p], 1.0 / n);
    }
  }
}

// Tests elements of a patch that draws from a grid, and of one that does not.
TEST(PatchSampler, OfOneElementIsUniformOnIt) {
  Scene scene = empty_scene();
  add_polygon(scene, "square", {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, {}, 1);
  add_polygon(scene, "triangle", {{5, 0, 0}, {7, 0.3, 0.5}, {5.5, 2, 1}}, {}, 1);
  const PatchMesh mesh =
      build_patches(scene, {.max_patch_size = 1.0, .elements_per_patch_edge = 3});
  const int n = 200;
  for (int e = 0; e < mesh.element_count(); ++e) {
    Vector3d mean = Vector3d::Zero();
    const PatchSampler sampler(mesh, mesh.patch[e], e);
    for_each_sample(n, [&](double u, double v) {
      const PatchPoint point = sampler.point(u, v);
      ASSERT_EQ(point.element, e);
      mean += point.position / (n * n);
    });
    Vector3d centroid = Vector3d::Zero();
    const auto& c = mesh.corners[e];
    for (int i = 1; i + 1 < mesh.corner_count(e); ++i) {
      const Vector3d a = mesh.position(c[0]), b = mesh.position(c[i]), d = mesh.position(c[i + 1]);
      centroid += 0.5 * (b - a).cross(d - a).norm() * (a + b + d) / 3.0;
    }
    centroid /= mesh.element_area[e];
    // Error of a midpoint rule of n strips over half a metre at most.
    EXPECT_NEAR((mean - centroid).norm(), 0.0, 0.5 / n);
  }
}

TEST(PatchSampler, OnASphereLiesOnTheSphereAndIsUniform) {
  Scene scene = empty_scene();
  const Sphere ball{.center = {1, 2, 3}, .radius = 0.7};
  add_sphere(scene, "ball", ball);
  const PatchMesh mesh = build_patches(scene, {.max_patch_size = 0.8});
  Vector3d mean = Vector3d::Zero();
  double mean_z2 = 0.0;
  const int n = 60;
  for (int p = 0; p < mesh.patch_count(); ++p) {
    const bool inner = mesh.is_back[p] != 0;
    const PatchSampler sampler(mesh, p);
    for_each_sample(n, [&](double u, double v) {
      const PatchPoint point = sampler.point(u, v);
      const Vector3d d = (point.position - ball.center) / ball.radius;
      ASSERT_NEAR(d.norm(), 1.0, 1e-12);
      ASSERT_NEAR(point.normal.dot(d), inner ? -1.0 : 1.0, 1e-12);
      if (inner) return;
      const double weight = mesh.area[p] / (n * n) / (4 * std::numbers::pi * 0.49);
      mean += weight * d;
      mean_z2 += weight * d.z() * d.z();
    });
  }
  EXPECT_NEAR(mean.norm(), 0.0, 1e-3);  // midpoint rule, O(1/n^2) = 3e-4 and jumps at elements
  EXPECT_NEAR(mean_z2, 1.0 / 3.0, 1e-3);
}

TEST(PatchSampler, CoversTheEndsOfItsRange) {
  const PatchMesh mesh = build_patches(cornell_box(), {.max_patch_size = 0.2});
  const double last = std::nextafter(1.0, 0.0);
  for (int p = 0; p < mesh.patch_count(); ++p) {
    const PatchSampler sampler(mesh, p);
    for (double u : {0.0, 0.25, last}) {
      for (double v : {0.0, last}) {
        const PatchPoint point = sampler.point(u, v);
        ASSERT_EQ(mesh.patch[point.element], p);
        ASSERT_TRUE(point.position.allFinite());
      }
    }
  }
}

TEST(BuildTopology, RestoresAMeshFromItsArrays) {
  Scene scene = cornell_box();
  add_sphere(scene, "ball", {.center = {0.3, 0.4, 0.3}, .radius = 0.08});
  const PatchMesh mesh = build_patches(scene, {.max_patch_size = 0.1});
  std::vector<Vector3d> positions;
  for (int v = 0; v < mesh.vertex_count(); ++v) positions.push_back(mesh.position(v));
  PatchMesh copy = mesh;
  copy.elements = {};
  copy.vertex_normal.clear();
  build_topology(copy, positions);
  expect_consistent(copy);
  EXPECT_EQ(copy.vertex_normal, mesh.vertex_normal);
  EXPECT_EQ(copy.elements->n_edges(), mesh.elements->n_edges());
}

// A move transfers the half-edge mesh and leaves an empty one that can be used again.
TEST(PatchMesh, IsMovedWithoutACopy) {
  const Scene scene = cornell_box();
  PatchMesh mesh = build_patches(scene, {.max_patch_size = 0.2});
  const PatchMesh copy = mesh;
  EXPECT_NE(&*copy.elements, &*mesh.elements);
  const HalfedgeMesh* const before = &*mesh.elements;
  PatchMesh moved = std::move(mesh);
  EXPECT_EQ(&*moved.elements, before);
  expect_consistent(moved);
  EXPECT_EQ(mesh.elements->n_faces(), 0u);  // NOLINT(bugprone-use-after-move)
  mesh = std::move(moved);
  EXPECT_EQ(&*mesh.elements, before);
  EXPECT_EQ(mesh.elements->n_edges(), copy.elements->n_edges());
}

TEST(BuildTopology, RefusesElementsThatDoNotFit) {
  Scene scene = empty_scene();
  add_polygon(scene, "plate", {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, {}, 1);
  PatchMesh mesh = build_patches(scene, {.max_patch_size = 0.5});
  std::vector<Vector3d> positions;
  for (int v = 0; v < mesh.vertex_count(); ++v) positions.push_back(mesh.position(v));
  PatchMesh doubled = mesh;
  doubled.corners[1] = doubled.corners[0];
  EXPECT_THROW(build_topology(doubled, positions), std::runtime_error);
  PatchMesh beyond = mesh;
  beyond.corners[1][2] = 1000;
  EXPECT_THROW(build_topology(beyond, positions), std::runtime_error);
}

}  // namespace
}  // namespace lightwell::patch_geometry_test
