#include "mesh/cleaning/facet_check.h"

#include <gtest/gtest.h>

#include <array>

namespace lightwell::facet_check_test {
namespace {

// The unit cube with outward faces; face f is turned inside out if reversed[f].
Scene cube(int reversed = -1) {
  PolygonMesh mesh;
  for (int i = 0; i < 8; ++i) mesh.vertices.emplace_back(i & 1, (i >> 1) & 1, (i >> 2) & 1);
  const std::array<std::vector<int>, 6> faces = {
      {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}}};
  for (int f = 0; f < 6; ++f) {
    std::vector<int> loop = faces[static_cast<std::size_t>(f)];
    if (f == reversed) loop = {loop.rbegin(), loop.rend()};
    mesh.facets.push_back({.boundary = loop});
  }
  Scene scene;
  scene.surfaces.push_back({.name = "cube", .shape = mesh});
  return scene;
}

PolygonMesh& mesh_of(Scene& scene) {
  return std::get<PolygonMesh>(scene.surfaces[0].shape);
}

TEST(FacetCheck, AClosedCubeIsInOrder) {
  const FacetCheck check = check_facets(cube());
  EXPECT_EQ(check.open_edges, 0);
  EXPECT_EQ(check.inconsistent_edges, 0);
  EXPECT_TRUE(check.duplicates.empty());
  EXPECT_TRUE(check.opposites.empty());
}

TEST(FacetCheck, ACubeWithoutLidIsOpenAlongFourEdges) {
  Scene scene = cube();
  mesh_of(scene).facets.pop_back();
  EXPECT_EQ(check_facets(scene).open_edges, 4);
}

TEST(FacetCheck, AReversedFaceDisagreesAlongItsFourEdges) {
  for (int face = 0; face < 6; ++face) {
    const FacetCheck check = check_facets(cube(face));
    EXPECT_EQ(check.inconsistent_edges, 4);
    EXPECT_EQ(check.open_edges, 0);
  }
}

TEST(FacetCheck, DuplicatesAndOppositesAreFoundWhateverCornerTheyBeginWith) {
  Scene scene = cube();
  mesh_of(scene).facets.push_back({.boundary = {3, 1, 0, 2}});  // face 0 again
  mesh_of(scene).facets.push_back({.boundary = {6, 7, 5, 4}});  // face 1 from inside
  const FacetCheck check = check_facets(scene);
  ASSERT_EQ(check.duplicates.size(), 1u);
  EXPECT_EQ(check.duplicates[0].first, 0);
  EXPECT_EQ(check.duplicates[0].second, 6);
  ASSERT_EQ(check.opposites.size(), 1u);
  EXPECT_EQ(check.opposites[0].first, 1);
  EXPECT_EQ(check.opposites[0].second, 7);
  EXPECT_EQ(check.open_edges, 0);
}

TEST(FacetCheck, CornersThatDifferByARoundingAreOne) {
  Scene scene = cube();
  PolygonMesh& mesh = mesh_of(scene);
  // The lid with vertices of its own, as in STL files.
  std::vector<int> own;
  for (const int v : mesh.facets[1].boundary) {
    own.push_back(static_cast<int>(mesh.vertices.size()));
    mesh.vertices.push_back(mesh.vertices[static_cast<std::size_t>(v)] +
                            Eigen::Vector3d::Constant(1e-9));
  }
  mesh.facets[1].boundary = own;
  EXPECT_EQ(check_facets(scene).open_edges, 0);
}

}  // namespace
}  // namespace lightwell::facet_check_test
