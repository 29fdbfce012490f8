// Normals at vertices through cleaning and meshing: which facets are joined, and where vertices are
// shared.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <set>

#include "mesh/build_patches.h"
#include "mesh/cleaning/planar_regions.h"
#include "mesh/patches/patch_mesh.h"
#include "scene/facet_normals.h"
#include "scene/io/corner_maps.h"
#include "scene/io/mesh_builder.h"
#include "scene/io/polygon.h"
#include "tests/mesh/mesh_scenes.h"

namespace lightwell::smooth_edges_test {
namespace {

using Eigen::Vector3d;

enum class Given { nothing, smooth, hard };

// Four chords of a quarter of a cylinder, of two triangles each, and a flat strip that continues
// the last.
Scene bent_sheet(Given given) {
  MeshBuilder mesh;
  const auto on_circle = [](double turn, double z) {
    const double angle = turn * std::numbers::pi / 8.0;
    return Vector3d(std::cos(angle), std::sin(angle), z);
  };
  const auto add = [&](const Loop& square, const NormalLoop& normals) {
    for (const auto& t : {std::array{0, 1, 2}, {0, 2, 3}}) {
      NormalLoop there;
      for (const int i : t) {
        if (!normals.empty()) there.push_back(normals[static_cast<std::size_t>(i)]);
      }
      mesh.add({.boundary = {square[static_cast<std::size_t>(t[0])],
                             square[static_cast<std::size_t>(t[1])],
                             square[static_cast<std::size_t>(t[2])]}},
               {}, there);
    }
  };
  for (int i = 0; i < 4; ++i) {
    const Loop square = {on_circle(i, 0), on_circle(i + 1, 0), on_circle(i + 1, 1),
                         on_circle(i, 1)};
    NormalLoop normals;
    for (const Vector3d& p : square) normals.emplace_back(p.x(), p.y(), 0);
    if (given == Given::hard) normals.assign(4, on_circle(i + 0.5, 0));
    add(square, given == Given::nothing ? NormalLoop{} : normals);
  }
  const Loop strip = {{0, 1, 0}, {-1, 1, 0}, {-1, 1, 1}, {0, 1, 1}};
  add(strip, given == Given::nothing ? NormalLoop{} : NormalLoop(4, Vector3d::UnitY()));
  Scene scene = test::empty_scene();
  scene.surfaces.push_back({.name = "sheet", .shape = mesh.mesh()});
  validate(scene);
  return scene;
}

const PolygonMesh& polygons(const Scene& scene) {
  return std::get<PolygonMesh>(scene.surfaces[0].shape);
}

TEST(SmoothEdges, TrianglesOfOneChordAreJoinedAndKeepTheirNormals) {
  const Scene clean = merge_planar_regions(bent_sheet(Given::smooth));
  ASSERT_EQ(polygons(clean).facets.size(), 5u);
  const FacetNormals normals(clean);
  for (int f = 0; f < 5; ++f) {
    const Facet& facet = polygons(clean).facets[static_cast<std::size_t>(f)];
    EXPECT_EQ(facet.normal_map >= 0, f < 4) << "the strip is flat";
    const Vector3d flat = facet_normal(polygons(clean), facet);
    for (const int v : facet.boundary) {
      const Vector3d& p = polygons(clean).vertices[static_cast<std::size_t>(v)];
      const Vector3d expected = f < 4 ? Vector3d(p.x(), p.y(), 0) : Vector3d::UnitY();
      EXPECT_LT((normals.at(f, p, flat) - expected).norm(), 3e-4);
    }
  }
}

TEST(SmoothEdges, FacetsOnWhichNormalsDoNotGoOnStayApart) {
  Scene scene = test::empty_scene();
  MeshBuilder mesh;
  const Vector3d up = Vector3d::UnitZ(), lean = {0.5, 0, 1};
  mesh.add({.boundary = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}}}, {}, {up, lean, up});
  mesh.add({.boundary = {{0, 0, 0}, {1, 1, 0}, {0, 1, 0}}}, {}, {up, up, lean});
  scene.surfaces.push_back({.name = "sheet", .shape = mesh.mesh()});
  EXPECT_EQ(polygons(merge_planar_regions(scene)).facets.size(), 2u);
  auto& facets = std::get<PolygonMesh>(scene.surfaces[0].shape).facets;
  facets[0].normal_map = facets[1].normal_map = -1;
  EXPECT_EQ(polygons(merge_planar_regions(scene)).facets.size(), 1u);
}

// The number of the four edges between the five facets whose vertices are shared on one side.
int shared_edges(const Scene& scene) {
  const PatchMesh mesh = build_patches(merge_planar_regions(scene), {.max_patch_size = 4.0});
  std::array<std::set<int>, 5> vertices;
  for (int e = 0; e < mesh.element_count(); ++e) {
    if (mesh.is_back[mesh.patch[e]] != 0) continue;
    for (int c = 0; c < mesh.corner_count(e); ++c) {
      vertices[static_cast<std::size_t>(mesh.facet[e])].insert(mesh.corners[e][c]);
    }
  }
  int shared = 0;
  for (std::size_t f = 0; f + 1 < vertices.size(); ++f) {
    shared += std::ranges::any_of(vertices[f], [&](int v) { return vertices[f + 1].contains(v); });
  }
  return shared;
}

TEST(SmoothEdges, VerticesAreSharedWhereNormalsAgree) {
  EXPECT_EQ(shared_edges(bent_sheet(Given::smooth)), 4);
  EXPECT_EQ(shared_edges(bent_sheet(Given::hard)), 0);
  EXPECT_EQ(shared_edges(bent_sheet(Given::nothing)), 0);
}

}  // namespace
}  // namespace lightwell::smooth_edges_test
