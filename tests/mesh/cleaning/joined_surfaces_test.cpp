#include "mesh/cleaning/joined_surfaces.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "mesh/build_patches.h"
#include "mesh/cleaning/planar_regions.h"
#include "mesh/patches/element_quality.h"
#include "tests/mesh/mesh_scenes.h"

namespace lightwell::joined_surfaces_test {
namespace {

using namespace lightwell::test;
using Eigen::Vector3d;

const PolygonMesh& mesh_of(const Scene& scene, int surface) {
  return std::get<PolygonMesh>(scene.surfaces[surface].shape);
}

int facet_count(const Scene& scene) {
  return static_cast<int>(scene_facets(scene).size());
}

Loop rectangle(double x0, double y0, double x1, double y1) {
  return {{x0, y0, 0}, {x1, y0, 0}, {x1, y1, 0}, {x0, y1, 0}};
}

std::string square_name(int x, int y) {
  return fmt::format("square {} {}", x, y);
}

/// The square from 0 to n, as n^2 surfaces with different names.
Scene squares(int n, int material = 0) {
  Scene scene = empty_scene();
  for (int x = 0; x < n; ++x) {
    for (int y = 0; y < n; ++y) {
      add_polygon(scene, square_name(x, y), rectangle(x, y, x + 1, y + 1), {}, material);
    }
  }
  return scene;
}

// A black mirror beside a black lacquer, whose Material::specular is that of the mirror, and beside
// a lacquer of another index.
TEST(JoinedSurfaces, CoatsAreJoinedWithTheirLikeAlone) {
  Scene scene = squares(3);
  Material mirror = scene.materials[0];
  mirror.reflectance.setZero();
  mirror.specular.setOnes();
  scene.materials.assign(3, mirror);
  scene.materials[1].coat = Coat{.index_of_refraction = 1.5f};
  scene.materials[2].coat = Coat{.index_of_refraction = 1.6f};
  for (int s = 0; s < 9; ++s) scene.surfaces[static_cast<std::size_t>(s)].material = s / 3;
  EXPECT_EQ(facet_count(merge_planar_regions(scene)), 3);
}

// A square, the same square under another name that begins at another corner, the square turned
// over, and one of another material.
TEST(JoinedSurfaces, PolygonsThatLieOnEqualOnesGo) {
  Scene scene = empty_scene();
  const Loop loop = rectangle(0, 0, 1, 1);
  add_polygon(scene, "first", loop);
  add_polygon(scene, "again", {loop[2], loop[3], loop[0], loop[1]});
  add_polygon(scene, "turned over", {loop[3], loop[2], loop[1], loop[0]});
  scene.materials.push_back(scene.materials[0]);
  scene.materials.back().reflectance *= 0.5f;
  const int darker = static_cast<int>(scene.materials.size()) - 1;
  add_polygon(scene, "darker", loop, {}, darker);
  EXPECT_EQ(drop_shared_duplicates(scene), 1);
  EXPECT_EQ(mesh_of(scene, 0).facets.size(), 1u);
  EXPECT_EQ(mesh_of(scene, 1).facets.size(), 0u);
  EXPECT_EQ(mesh_of(scene, 2).facets.size(), 1u);
  EXPECT_EQ(mesh_of(scene, 3).facets.size(), 1u);
  EXPECT_EQ(drop_shared_duplicates(scene), 0);
}

TEST(JoinedSurfaces, SquaresOfOnePlaneBecomeOnePolygonAndKeepTheirNames) {
  constexpr int n = 5;
  const Scene apart = squares(n);
  Scene scene = apart;
  const auto names = join_surfaces(scene);
  ASSERT_TRUE(names);
  EXPECT_EQ(facet_count(scene), 1);
  ASSERT_EQ(scene.surfaces.size(), apart.surfaces.size());  // numbers and names stay
  EXPECT_EQ(mesh_of(scene, 0).facets.size(), 1u);
  EXPECT_EQ(mesh_of(scene, 0).vertices.size(), 4u);
  EXPECT_DOUBLE_EQ(surface_area(scene.surfaces[0]), n * n);
  for (int x = 0; x < n; ++x) {
    for (int y = 0; y < n; ++y) {
      const int s = names->surface_at({x + 0.01, y + 0.99, 0.0}, Vector3d::UnitZ());
      ASSERT_GE(s, 0);
      EXPECT_EQ(scene.surfaces[s].name, square_name(x, y));
    }
  }
  EXPECT_EQ(names->surface_at({0.5, 0.5, 0.0}, -Vector3d::UnitZ()), -1);  // the back
  EXPECT_EQ(names->surface_at({0.5, 0.5, 0.1}, Vector3d::UnitZ()), -1);   // above the square
  EXPECT_EQ(names->surface_at({n + 0.1, 0.5, 0.0}, Vector3d::UnitZ()), -1);
  EXPECT_EQ(scene_hash(names->apart(scene)), scene_hash(apart));
}

TEST(JoinedSurfaces, SquaresHaveThePatchesOfOneSurface) {
  constexpr int n = 6;
  Scene one = empty_scene();
  add_polygon(one, "all", rectangle(0, 0, n, n));
  CleanUpReport report;
  const Scene many = merge_planar_regions(squares(n), &report);
  ASSERT_TRUE(report.names);
  EXPECT_EQ(report.joined, n * n - 1);
  EXPECT_FALSE(report.is_clean());
  const MeshOptions options{.max_patch_size = 0.75};
  const PatchMesh mesh = build_patches(many, options), expected = build_patches(one, options);
  ASSERT_EQ(mesh.patch_count(), expected.patch_count());
  EXPECT_EQ(mesh.corners, expected.corners);
  for (int e = 0; e < mesh.element_count(); ++e) {
    const Vector3d middle = element_center(mesh, e).position;
    const int s = report.names->surface_of(mesh, e, middle);
    EXPECT_EQ(many.surfaces[s].name,
              square_name(static_cast<int>(middle.x()), static_cast<int>(middle.y())));
  }
}

TEST(JoinedSurfaces, WhatIsLitOtherwiseStaysApart) {
  const auto joins = [](const auto& change) {
    Scene scene = squares(2);
    for (int s : {1, 2, 3}) change(scene, s);
    const std::uint64_t before = scene_hash(scene);
    const bool is_joined = join_surfaces(scene) != nullptr;
    EXPECT_EQ(scene_hash(scene) != before, is_joined);
    return is_joined;
  };
  const auto with_material = [&](const auto& change) {
    return joins([&](Scene& scene, int s) {
      Material material = scene.materials[0];
      material.name = fmt::format("paint {}", s);
      change(material, s);
      scene.materials.push_back(material);
      scene.surfaces[s].material = static_cast<int>(scene.materials.size()) - 1;
    });
  };
  EXPECT_TRUE(with_material([](Material&, int) {}));  // only the names differ
  EXPECT_FALSE(with_material([](Material& m, int s) { m.reflectance *= 1.0f / (1.0f + s); }));
  EXPECT_FALSE(with_material([](Material& m, int s) {
    m.specular = Spectrum::Constant(3, 0.1f * static_cast<float>(s));
  }));
  // Lamps are dimmed one by one, by name.
  EXPECT_FALSE(with_material([](Material& m, int) { m.emission = Spectrum::Ones(3); }));
  EXPECT_FALSE(with_material([](Material& m, int) { m.dielectric = Dielectric{}; }));
  EXPECT_FALSE(joins([](Scene& scene, int s) { scene.surfaces[s].motion = s; }));
  const auto with_shape = [&](const auto& change) {
    return joins(
        [&](Scene& scene, int s) { change(std::get<PolygonMesh>(scene.surfaces[s].shape), s); });
  };
  EXPECT_FALSE(with_shape([](PolygonMesh& mesh, int s) {
    for (Vector3d& v : mesh.vertices) v.z() += 1e-3 * s;
  }));
  EXPECT_FALSE(with_shape([](PolygonMesh& mesh, int s) {
    for (Vector3d& v : mesh.vertices) v.x() += 3.0 * s;
  }));
  EXPECT_FALSE(with_shape([](PolygonMesh& mesh, int s) {
    if (s != 3) std::ranges::reverse(mesh.facets[0].boundary);  // 0 and 3 touch at a corner alone
  }));
}

TEST(JoinedSurfaces, WhatFillsAHoleStaysAnObjectOfItsOwn) {
  Scene scene = empty_scene();
  Loop hole = rectangle(0.4, 0.4, 0.6, 0.6);
  std::ranges::reverse(hole);
  add_polygon(scene, "wall", rectangle(0, 0, 1, 1), {hole});
  add_polygon(scene, "switch", rectangle(0.4, 0.4, 0.6, 0.6));
  EXPECT_FALSE(join_surfaces(scene));
  add_polygon(scene, "more wall", rectangle(1, 0, 2, 1));
  const auto names = join_surfaces(scene);
  ASSERT_TRUE(names);
  EXPECT_EQ(facet_count(scene), 2);
  EXPECT_DOUBLE_EQ(surface_area(scene.surfaces[0]), 2.0 - 0.04);
  EXPECT_DOUBLE_EQ(surface_area(scene.surfaces[1]), 0.04);
  EXPECT_EQ(mesh_of(scene, 2).facets.size(), 0u);
}

// Squares divided differently from their neighbours meet these along parts of edges.
TEST(JoinedSurfaces, EdgesMayMeetInParts) {
  Scene scene = empty_scene();
  add_polygon(scene, "left", rectangle(0, 0, 1, 3));
  add_polygon(scene, "below", rectangle(1, 0, 2, 1));
  add_polygon(scene, "above", rectangle(1, 1, 2, 3));
  ASSERT_TRUE(join_surfaces(scene));
  EXPECT_EQ(facet_count(scene), 1);
  EXPECT_EQ(mesh_of(scene, 0).facets[0].boundary.size(), 4u);
}

// The polygons of a surface that are not joined stay in their places.
TEST(JoinedSurfaces, OtherPolygonsOfASurfaceStay) {
  Scene scene = empty_scene();
  add_box(scene, "left", {0, 0, 0}, {1, 1, 1});
  add_box(scene, "right", {1, 0, 0}, {2, 1, 1});
  const double area = scene_area(scene);
  ASSERT_TRUE(join_surfaces(scene));
  // Each of the four sides that both have became one polygon; the two faces in between cover each
  // other.
  EXPECT_EQ(facet_count(scene), 8);
  EXPECT_DOUBLE_EQ(scene_area(scene), area);
  EXPECT_NO_THROW(build_patches(scene, {.max_patch_size = 0.5}));
}

}  // namespace
}  // namespace lightwell::joined_surfaces_test
