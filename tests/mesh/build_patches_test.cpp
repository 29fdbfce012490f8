#include "mesh/build_patches.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <numbers>

#include "mesh/geometry/cut_size.h"
#include "scene/errors.h"
#include "scene/parallel.h"
#include "tests/mesh/mesh_scenes.h"

namespace lightwell::build_patches_test {
namespace {

using namespace lightwell::test;
using Eigen::Vector3d;

void expect_facet_areas(const Scene& scene, const PatchMesh& mesh) {
  const auto facets = scene_facets(scene);
  for (int f = 0; f < static_cast<int>(facets.size()); ++f) {
    const Surface& surface = scene.surfaces[facets[f].surface];
    const auto* polygons = std::get_if<PolygonMesh>(&surface.shape);
    if (!polygons) continue;
    const double area = facet_area(*polygons, polygons->facets[facets[f].facet]);
    // Rounding of a sum of some thousand areas: 1e-12.
    EXPECT_NEAR(side_area(mesh, f, false), area, 1e-12 * area) << surface.name;
  }
}

TEST(BuildPatches, CornellBoxIsCoveredExactlyAndConforms) {
  const Scene scene = cornell_box();
  for (const double size : {0.1, 0.05, 0.031}) {
    const PatchMesh mesh = build_patches(scene, {.max_patch_size = size});
    expect_consistent(mesh);
    expect_facet_areas(scene, mesh);
    EXPECT_EQ(hanging_vertices(mesh), 0);
  }
}

// Inner points keep half a spacing s >= h/2 from every line, and lines are cut into pieces of h/2
// to h. A piece of length h with a point s/2 above its end would have an angle of atan(1/4) = 14
// degrees. Corners where lines meet belong to the scene (all above 70 degrees here).
TEST(BuildPatches, FloorUnderTheCornellBlocksHasNoSlivers) {
  for (int i = 0; i < 12; ++i) {
    const double size = 0.03 + 0.01 * i;
    const PatchMesh mesh = build_patches(cornell_box(), {.max_patch_size = size});
    const double angle = smallest_angle(mesh);
    RecordProperty("smallest_angle_" + std::to_string(i), std::to_string(angle));
    EXPECT_GT(angle, 14.0) << "patch size " << size;
  }
}

TEST(BuildPatches, RectangleIsAGridOfSquarePatches) {
  Scene scene = empty_scene();
  add_polygon(scene, "wall", {{0, 0, 0}, {3, 0, 0}, {3, 2, 0}, {0, 2, 0}}, {}, 1);
  for (const int k : {1, 2, 3}) {
    const PatchMesh mesh =
        build_patches(scene, {.max_patch_size = 0.5, .elements_per_patch_edge = k});
    expect_consistent(mesh);
    ASSERT_EQ(mesh.patch_count(), 6 * 4);
    EXPECT_EQ(mesh.element_count(), 24 * k * k);
    EXPECT_EQ(mesh.vertex_count(), (6 * k + 1) * (4 * k + 1));
    EXPECT_NEAR(smallest_angle(mesh), 90.0, 1e-9);
    for (int p = 0; p < mesh.patch_count(); ++p) EXPECT_NEAR(mesh.area[p], 0.25, 1e-14);
  }
}

TEST(BuildPatches, ElementsOfAGivenSizeMakeNoMorePatchesThanAllowed) {
  Scene scene = empty_scene();
  add_polygon(scene, "wall", {{0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {0, 4, 0}}, {}, 1);
  // Patches have two elements per edge, or more where there would be more than 64 patches.
  PatchMesh mesh = build_patches(scene, {.max_element_size = 0.25, .most_patches = 64});
  EXPECT_EQ(mesh.patch_count(), 64);
  EXPECT_EQ(mesh.element_count(), 256);
  mesh = build_patches(scene, {.max_element_size = 0.125, .most_patches = 64});
  EXPECT_EQ(mesh.patch_count(), 64);
  EXPECT_EQ(mesh.element_count(), 1024);
  // A given patch size is kept.
  mesh = build_patches(scene, {.max_patch_size = 0.25, .max_element_size = 0.125});
  EXPECT_EQ(mesh.patch_count(), 256);
  EXPECT_EQ(mesh.element_count(), 1024);
  // A size written as text and read again may lose its last digits.
  EXPECT_EQ(cut_size(scene, {.max_patch_size = 0.7, .max_element_size = 0.1}).elements_per_edge, 7);
  EXPECT_THROW(build_patches(scene, {.max_patch_size = 0.1, .max_element_size = 0.2}), InputError);
  EXPECT_THROW(build_patches(scene, {.max_element_size = -1.0}), InputError);
  EXPECT_THROW(build_patches(scene, {.max_element_size = 1e-5}), InputError);  // 1.6e11 elements
}

TEST(BuildPatches, SlightlyTrapezoidalWallStaysAGridOfQuadrilaterals) {
  Scene scene = empty_scene();
  // The Cornell floor, whose opposite edges differ by 0.6 %: rounding up may differ by one.
  add_polygon(scene, "floor", {{0, 0, 0}, {0.5528, 0, 0}, {0.5496, 0.5592, 0}, {0, 0.5592, 0}});
  for (double size = 0.01; size < 0.2; size *= 1.17) {
    const PatchMesh mesh = build_patches(scene, {.max_patch_size = size});
    for (int e = 0; e < mesh.element_count(); ++e) ASSERT_EQ(mesh.corner_count(e), 4);
    EXPECT_GT(smallest_angle(mesh), 89.0);
  }
}

TEST(BuildPatches, AnyPolygonIsCoveredExactly) {
  Scene scene = empty_scene();
  add_polygon(scene, "L", {{0, 0, 0}, {2, 0, 0}, {2, 1, 0}, {1, 1, 0}, {1, 3, 0}, {0, 3, 0}});
  add_polygon(scene, "triangle", {{5, 0, 0}, {7, 0.3, 0.5}, {5.5, 2, 1}});
  add_polygon(
      scene, "two holes", {{0, 5, 1}, {4, 5, 1}, {4, 8, 1}, {0, 8, 1}},
      {{{1, 6, 1}, {1, 7, 1}, {1.7, 6.5, 1}}, {{2, 6, 1}, {2, 7, 1}, {3, 7, 1}, {3, 6, 1}}});
  Loop disk;
  for (int i = 0; i < 60; ++i) {
    disk.emplace_back(10 + std::cos(i * std::numbers::pi / 30), std::sin(i * std::numbers::pi / 30),
                      0.2);
  }
  add_polygon(scene, "disk", disk);
  // A hole joined to the outside by a bridge that the boundary passes forth and back.
  add_polygon(scene, "bridged hole",
              {{20, 0, 0},
               {24, 0, 0},
               {24, 4, 0},
               {20, 4, 0},
               {20, 0, 0},
               {21, 1, 0},
               {21, 3, 0},
               {23, 3, 0},
               {23, 1, 0},
               {21, 1, 0}});
  // A hole that touches the boundary in a point.
  add_polygon(scene, "touching hole", {{30, 0, 0}, {34, 0, 0}, {34, 4, 0}, {30, 4, 0}},
              {{{32, 0, 0}, {31, 1, 0}, {32, 2, 0}, {33, 1, 0}}});
  add_polygon(scene, "sliver", {{40, 0, 0}, {44, 0, 0}, {44, 1e-4, 0}, {40, 1e-4, 0}});
  for (const double size : {10.0, 0.5, 0.13}) {
    const PatchMesh mesh = build_patches(scene, {.max_patch_size = size});
    expect_consistent(mesh);
    expect_facet_areas(scene, mesh);
    EXPECT_EQ(hanging_vertices(mesh), 0);
  }
}

TEST(BuildPatches, BoxOfSixFacetsMeetsPointByPoint) {
  for (const bool one_surface : {true, false}) {
    Scene scene = empty_scene();
    add_box(scene, "box", {0, 0, 0}, {1.03, 0.77, 0.59}, one_surface);
    const PatchMesh mesh = build_patches(scene, {.max_patch_size = 0.1});
    expect_consistent(mesh);
    EXPECT_EQ(hanging_vertices(mesh), 0);
    // Faces meet at 90 degrees: no vertex is shared, so each side of each face is its own disk.
    EXPECT_EQ(static_cast<int>(mesh.elements->n_vertices()) -
                  static_cast<int>(mesh.elements->n_edges()) +
                  static_cast<int>(mesh.elements->n_faces()),
              12);
  }
}

TEST(BuildPatches, WallsOfDifferentLengthLeaveNoHangingVertex) {
  Scene scene = empty_scene();
  add_polygon(scene, "long", {{0, 0, 0}, {3, 0, 0}, {3, 0, 1}, {0, 0, 1}});
  add_polygon(scene, "left", {{0, 0, 0}, {1.3, 0, 0}, {1.3, -1, 0}, {0, -1, 0}});
  add_polygon(scene, "right", {{1.3, 0, 0}, {3, 0, 0}, {3, -1, 0}, {1.3, -1, 0}});
  const PatchMesh mesh = build_patches(scene, {.max_patch_size = 0.3});
  expect_consistent(mesh);
  expect_facet_areas(scene, mesh);
  EXPECT_EQ(hanging_vertices(mesh), 0);
}

TEST(BuildPatches, WarpedWallOfTwoTrianglesSharesVerticesAndNormals) {
  const Scene scene = cornell_box();
  const PatchMesh smooth = build_patches(scene, {.max_patch_size = 0.1});
  const PatchMesh faceted =
      build_patches(scene, {.max_patch_size = 0.1, .smooth_angle_degrees = 0.01});
  const auto shared_by_two_facets = [&](const PatchMesh& mesh) {
    std::vector<int> facet_of(mesh.vertex_count(), -1);
    int count = 0;
    for (int e = 0; e < mesh.element_count(); ++e) {
      for (int i = 0; i < mesh.corner_count(e); ++i) {
        int& f = facet_of[mesh.corners[e][i]];
        const int facet = mesh.facet[e];
        if (f >= 0 && f != facet) ++count;
        f = facet;
      }
    }
    return count;
  };
  // The halves meet at 0.5 degrees; all other neighbours are of different surfaces.
  EXPECT_GT(shared_by_two_facets(smooth), 0);
  EXPECT_EQ(shared_by_two_facets(faceted), 0);
}

TEST(BuildPatches, TessellatedCylinderIsSmoothAroundAndSharpAtItsRim) {
  Scene scene = empty_scene();
  PolygonMesh tube;
  const int n = 90;  // 4 degrees from facet to facet
  for (int i = 0; i < n; ++i) {
    const double a = 2 * std::numbers::pi * i / n;
    tube.vertices.emplace_back(std::cos(a), std::sin(a), 0);
    tube.vertices.emplace_back(std::cos(a), std::sin(a), 1);
  }
  Facet lid;
  for (int i = 0; i < n; ++i) {
    const int j = (i + 1) % n;
    tube.facets.push_back({.boundary = {2 * i, 2 * j, 2 * j + 1, 2 * i + 1}});
    lid.boundary.push_back(2 * i + 1);
  }
  tube.facets.push_back(lid);
  scene.surfaces.push_back({.name = "tube", .material = 0, .shape = tube});
  const PatchMesh mesh = build_patches(scene, {.max_patch_size = 0.25});
  expect_consistent(mesh);
  EXPECT_EQ(hanging_vertices(mesh), 0);
  for (int e = 0; e < mesh.element_count(); ++e) {
    const bool is_lid = mesh.facet[e] == n;
    const double side = mesh.is_back[mesh.patch[e]] != 0 ? -1 : 1;
    for (int i = 0; i < mesh.corner_count(e); ++i) {
      const Vector3d p = mesh.position(mesh.corners[e][i]);
      Vector3d radial = is_lid ? Vector3d::UnitZ() : Vector3d(p.x(), p.y(), 0).normalized();
      // The mean of two neighbouring normals is radial where the facets meet, by symmetry.
      if (!is_lid && std::hypot(p.x(), p.y()) < 1 - 1e-9) continue;
      EXPECT_NEAR((side * mesh.vertex_normal[mesh.corners[e][i]] - radial).norm(), 0, 1e-9);
    }
  }
}

TEST(BuildPatches, PatchesStayWithinTheirSize) {
  const Scene scene = cornell_box();
  const double size = 0.05;
  const PatchMesh mesh = build_patches(scene, {.max_patch_size = size});
  double worst = 0.0;
  for (int p = 0; p < mesh.patch_count(); ++p) {
    std::vector<Vector3d> corners;
    for (int e = mesh.first_element[p]; e < mesh.first_element[p + 1]; ++e) {
      for (int i = 0; i < mesh.corner_count(e); ++i) {
        corners.push_back(mesh.position(mesh.corners[e][i]));
      }
    }
    for (const Vector3d& a : corners) {
      for (const Vector3d& b : corners) worst = std::max(worst, (a - b).norm());
    }
  }
  // The diagonal of a cell is sqrt(2) size. A patch with a leftover may be half a cell larger each
  // way, and an element sticks out of a cell by less than half of its own size.
  EXPECT_LE(worst, std::sqrt(2.0) * size * 1.5);
  // On a facet that nothing cuts the bound is exact: the right wall is a plain grid.
  for (int p = 0; p < mesh.patch_count(); ++p) {
    if (scene.surfaces[mesh.surface[p]].name != "right wall") continue;
    EXPECT_LE(mesh.area[p], size * size);
  }
}

TEST(BuildPatches, SidesFollowTheMaterial) {
  Scene scene = empty_scene();
  Material lamp = diffuse("lamp", 0.3f);
  lamp.emission = constant_spectrum(scene.bands, 7.0f);
  Material both = lamp;
  both.emits_both_sides = true;
  Material glass = diffuse("glass", 0.0f);
  glass.dielectric =
      Dielectric{.index_of_refraction = 1.5f, .tint = constant_spectrum(scene.bands, 1.0f)};
  scene.materials.insert(scene.materials.end(), {lamp, both, glass});
  for (int m = 0; m < 5; ++m) {
    const double z = m;
    add_polygon(scene, "plate", {{0, 0, z}, {1, 0, z}, {1, 1, z}, {0, 1, z}}, {}, m);
  }
  const PatchMesh mesh = build_patches(scene, {.max_patch_size = 1.0});
  expect_consistent(mesh);
  const std::array<double, 5> back_area{1, 0, 1, 1, 0}, back_emission{0, 0, 0, 7, 0};
  for (int p = 0; p < mesh.patch_count(); ++p) {
    const int m = mesh.material[p];
    const bool is_back = mesh.is_back[p] != 0;
    EXPECT_EQ(mesh.emission(p, 1), is_back ? back_emission[m] : m == 2 || m == 3 ? 7.0f : 0.0f);
    EXPECT_EQ(mesh.reflectance(p, 2), scene.materials[m].reflectance[2]);
    const Vector3d normal = element_center(mesh, mesh.first_element[p]).normal;
    EXPECT_NEAR(normal.z(), is_back ? -1 : 1, 1e-15);
  }
  for (int m = 0; m < 5; ++m) EXPECT_NEAR(side_area(mesh, m, true), back_area[m], 1e-14);
}

// Shelves of 4 m x 5 m in a room of 4 m x 5 m x 3 m, both sides of each: the mean free path is 4 V
// / A, and an edge is a quarter of that, but neither longer than that of even patches nor so short
// that there are more than 2.5 times as many.
TEST(BuildPatches, AutomaticSizeFollowsTheMeanFreePath) {
  for (const int shelves : {0, 3, 5, 10}) {
    Scene scene = empty_scene();
    add_box(scene, "room", {0, 0, 0}, {4, 5, 3}, true, 1);
    for (int i = 0; i < shelves; ++i) {
      const double z = 3.0 * (i + 1) / (shelves + 1);
      add_polygon(scene, "shelf", {{0, 0, z}, {4, 0, z}, {4, 5, z}, {0, 5, z}});
    }
    const double area = 94.0 + 2 * 20.0 * shelves, even = std::sqrt(area / 1600);
    const double of_path = 0.25 * 4.0 * 60.0 / (2 * 20.0 * shelves);
    const double expected = std::clamp(of_path, even / std::sqrt(2.5), even);
    // A sum of 16 areas, a product and a root round by some 20 * 2^-53 of less than 1 m.
    EXPECT_NEAR(cut_size(scene, {}).patch_size, expected, 1e-14) << shelves;
  }
}

TEST(BuildPatches, AutomaticSizeMakesAboutTheAskedNumberOfPatches) {
  const Scene scene = cornell_box();
  for (const int wanted : {400, 1600, 6400}) {
    const PatchMesh mesh = build_patches(scene, {.auto_patch_count = wanted});
    // Rounding up along both edges of a facet of L patches adds a share of about 1/L each; contact
    // lines cut patches in two.
    EXPECT_GT(mesh.patch_count(), 0.9 * wanted);
    EXPECT_LT(mesh.patch_count(), 1.6 * wanted);
  }
}

// A coat mirrors a little light beside what its diffuse base gives, so a coated room needs the
// patches of a matt one.
TEST(BuildPatches, CoatsLeaveTheAutomaticSizeAsItIs) {
  Scene scene = empty_scene();
  add_box(scene, "room", {0, 0, 0}, {4, 5, 3}, true, 1);
  const double matt = cut_size(scene, {}).patch_size;
  for (Material& material : scene.materials) {
    material.coat = Coat{};
    material.specular.setOnes();
    material.reflectance *= 0.5f;
  }
  EXPECT_EQ(cut_size(scene, {}).patch_size, matt);
}

Scene moved(Scene scene, double scale, const Eigen::Matrix3d& turn, const Vector3d& shift) {
  for (Surface& surface : scene.surfaces) {
    for (Vector3d& v : std::get<PolygonMesh>(surface.shape).vertices) {
      v = scale * (turn * v + shift);
    }
  }
  return scene;
}

TEST(BuildPatches, IsTheSameInEveryUnitAndPlace) {
  Scene scene = cornell_box();
  // A scene full of ties: the foot of the box runs midway between the grid lines of the floor.
  add_box(scene, "crate", {0.01, 0.2, 0.01}, {0.06, 0.4, 0.11});
  const PatchMesh mesh = build_patches(scene, {.max_patch_size = 0.05});
  const Eigen::Matrix3d turn =
      Eigen::AngleAxisd(0.7, Vector3d(1, -2, 0.5).normalized()).toRotationMatrix();
  const auto expect_same = [&](double scale, const Eigen::Matrix3d& rotation,
                               const Vector3d& shift) {
    const PatchMesh other =
        build_patches(moved(scene, scale, rotation, shift), {.max_patch_size = 0.05 * scale});
    EXPECT_EQ(other.corners, mesh.corners);
    EXPECT_EQ(other.patch, mesh.patch);
  };
  const Eigen::Matrix3d none = Eigen::Matrix3d::Identity();
  for (const double scale : {1e-3, 0.0254, 1.0 / 3.0, 10.0, 1e3}) {
    expect_same(scale, none, Vector3d::Zero());
  }
  expect_same(1.0, none, {3.3, -1.7, 0.9});
  expect_same(1.0, turn, {0, 0, 0});
  expect_same(0.3048, turn, {1, 2, 3});
}

TEST(BuildPatches, WallOnACoordinatePlaneStaysExactlyOnIt) {
  Scene scene = empty_scene();
  add_polygon(scene, "plain", {{1.9, 0, 0}, {1.9, 2, 0}, {1.9, 2, 2}, {1.9, 0, 2}});
  add_polygon(scene, "cut", {{0, 0, 0.7}, {3, 0, 0.7}, {3, 2, 0.7}, {0, 2, 0.7}});
  const PatchMesh mesh = build_patches(scene, {.max_patch_size = 0.15});
  for (int e = 0; e < mesh.element_count(); ++e) {
    const bool is_plain = mesh.facet[e] == 0;
    for (int i = 0; i < mesh.corner_count(e); ++i) {
      const Vector3d p = mesh.position(mesh.corners[e][i]);
      ASSERT_EQ(is_plain ? p.x() : p.z(), is_plain ? 1.9 : 0.7);
    }
  }
}

TEST(BuildPatches, TwoBuildsAreIdenticalForAnyNumberOfThreads) {
  Scene scene = cornell_box();
  add_sphere(scene, "ball", {.center = {0.3, 0.05, 0.3}, .radius = 0.08});
  const auto build = [&](int threads) {
    const ThreadLimit limit(threads);
    return build_patches(scene, {.max_patch_size = 0.04});
  };
  const PatchMesh a = build(1), b = build(4);
  EXPECT_EQ(a.corners, b.corners);
  EXPECT_EQ(a.patch, b.patch);
  EXPECT_EQ(a.twin, b.twin);
  EXPECT_EQ(a.vertex_normal, b.vertex_normal);
  EXPECT_TRUE((a.element_area == b.element_area).all());
  for (int v = 0; v < a.vertex_count(); ++v) ASSERT_EQ(a.position(v), b.position(v));
}

TEST(BuildPatches, MeshOfManyTrianglesIsSmoothAndOnePatchEachWhereNoneAreJoined) {
  const int n = 224;  // 100352 triangles
  const Scene scene = terrain(n);
  const auto start = std::chrono::steady_clock::now();
  const PatchMesh mesh = build_patches(scene, {.max_patch_size = 0.1, .curve_angle_degrees = 0.0});
  const double seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  std::printf("%d triangles meshed in %.2f s\n", 2 * n * n, seconds);
  EXPECT_EQ(mesh.element_count(), 2 * 2 * n * n);  // both sides
  EXPECT_EQ(mesh.patch_count(), mesh.element_count());
  ASSERT_EQ(static_cast<int>(mesh.elements->n_faces()), mesh.element_count());
  EXPECT_TRUE((mesh.area > 0.0).all());
}

TEST(BuildPatches, LargeMeshCutByAPlaneConforms) {
  Scene scene = terrain(40);
  add_polygon(scene, "water", {{-.1, -.1, 0}, {1.1, -.1, 0}, {1.1, 1.1, 0}, {-.1, 1.1, 0}});
  const PatchMesh mesh = build_patches(scene, {.max_patch_size = 0.05});
  expect_consistent(mesh);
  EXPECT_EQ(hanging_vertices(mesh), 0);
  for (int f = 0; f < 2 * 40 * 40; ++f) EXPECT_GT(side_area(mesh, f, false), 0.0);
}

template <class Call>
std::string message_of(Call&& call) {
  try {
    call();
  } catch (const InputError& error) {
    return error.what();
  }
  return "nothing was thrown";
}

TEST(BuildPatches, TooFineASizeIsRefusedWithItsCount) {
  const std::string message =
      message_of([] { build_patches(cornell_box(), {.max_patch_size = 1e-5}); });
  EXPECT_NE(message.find("1e-05"), std::string::npos) << message;
  EXPECT_NE(message.find("million elements"), std::string::npos) << message;
  EXPECT_NE(message.find("larger patch size"), std::string::npos) << message;
}

TEST(BuildPatches, BadOptionsAndScenesAreRefused) {
  EXPECT_NE(message_of([] { build_patches(empty_scene()); }).find("no surfaces"),
            std::string::npos);
  const Scene scene = cornell_box();
  EXPECT_THROW(build_patches(scene, {.max_patch_size = -1.0}), InputError);
  EXPECT_THROW(build_patches(scene, {.max_patch_size = std::nan("")}), InputError);
  EXPECT_THROW(build_patches(scene, {.elements_per_patch_edge = 0}), InputError);
  EXPECT_THROW(build_patches(scene, {.auto_patch_count = 0}), InputError);
}

// The edges from (3, 0) and from (2, 2) cross at (4/3, 5/3): a quadrilateral of 19/6 and a triangle
// of 1/6 are left. The crossing is known to 1e-16, so the sum of some hundred elements is off by
// less than 1e-12.
TEST(BuildPatches, SelfCrossingPolygonIsMeshedAndNamed) {
  Scene scene = empty_scene();
  add_polygon(scene, "bow tie", {{0, 0, 0}, {3, 0, 0}, {1, 2, 0}, {2, 2, 0}, {0, 1, 0}});
  const PatchMesh mesh = build_patches(scene, {.max_patch_size = 0.3});
  double area = 0.0;
  for (int p = 0; p < mesh.patch_count(); ++p) area += mesh.is_back[p] != 0 ? 0.0 : mesh.area[p];
  EXPECT_NEAR(area, 10.0 / 3.0, 1e-12);
  ASSERT_EQ(mesh.notes.size(), 1u);
  EXPECT_NE(mesh.notes[0].find("1 polygon crosses itself"), std::string::npos) << mesh.notes[0];
  EXPECT_NE(mesh.notes[0].find("polygon 0 of 'bow tie'"), std::string::npos) << mesh.notes[0];
}

TEST(PatchMesh, StopRequestIsHonoured) {
  EXPECT_THROW(build_patches(cornell_box(), {}, [](std::string_view, double) { return false; }),
               Interrupted);
  double last = 0.0;
  build_patches(cornell_box(), {}, [&](std::string_view phase, double share) {
    EXPECT_EQ(phase, "mesh");
    EXPECT_GE(share, last);
    last = share;
    return true;
  });
  EXPECT_EQ(last, 1.0);
}

TEST(BuildPatches, NeedlesOfInputSurvive) {
  Scene scene = empty_scene();
  add_polygon(scene, "floor", {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}});
  add_polygon(scene, "needle", {{0.2, 0.2, 0.1}, {0.8, 0.2, 0.1}, {0.5, 0.2 + 1e-10, 0.1}});
  add_polygon(scene, "speck", {{0.5, 0.5, 0.3}, {0.5 + 1e-9, 0.5, 0.3}, {0.5, 0.5 + 1e-9, 0.3}});
  const PatchMesh mesh = build_patches(scene, {.max_patch_size = 0.1});
  ASSERT_EQ(static_cast<int>(mesh.elements->n_faces()), mesh.element_count());
  EXPECT_TRUE((mesh.element_area > 0.0).all());
  for (int f = 0; f < 3; ++f) EXPECT_GT(side_area(mesh, f, false), 0.0);
}

}  // namespace
}  // namespace lightwell::build_patches_test
