#include "mesh/facets/facet_mesh.h"

#include <gtest/gtest.h>

#include "tests/mesh/mesh_scenes.h"

namespace lightwell::facet_mesh_test {
namespace {

using namespace lightwell::test;

// A triangle thinner than the welding tolerance has a corner on the opposite edge. An outline
// that passes through the corner there has no area inside; the triangle has.
TEST(FacetMesh, NeedlesThinnerThanTheWeldingToleranceKeepTheirArea) {
  Scene scene = empty_scene();
  add_polygon(scene, "needle", {{0, 0, 0}, {1e-4, 0.08, 0}, {0, 0.24, 0}});
  WeldedPoints points(2e-4);
  const std::vector<FacetPlane> planes = facet_planes(scene, points);
  ASSERT_EQ(planes.size(), 1u);
  const std::vector<int>& p = planes[0].point;
  ASSERT_EQ(p.size(), 3u);
  const FacetOutline outline{.loops = {{p[0], p[1], p[2], p[1]}}};
  const CutSize cut{.patch_size = 0.5, .elements_per_edge = 2};
  const FacetMesh mesh = mesh_facet(planes[0], outline, points.all(), {.cut = cut});
  ASSERT_FALSE(mesh.corners.empty());
  EXPECT_TRUE(mesh.is_flawed);
  double area = 0.0;
  for (const auto& c : mesh.corners) {
    const Eigen::Vector3d& a = mesh.position[c[0]];
    for (int i = 1; i < (c[3] < 0 ? 2 : 3); ++i) {
      area += 0.5 * (mesh.position[c[i]] - a).cross(mesh.position[c[i + 1]] - a).norm();
    }
  }
  // The pieces of one triangle add up to it, to the rounding of a few products.
  EXPECT_NEAR(area, 0.5 * 1e-4 * 0.24, 1e-15);
}

}  // namespace
}  // namespace lightwell::facet_mesh_test
