#include "viewer/export/lightmap_charts.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

#include "tests/raytrace/lit_scene.h"

namespace lightwell::lightmap_charts_test {
namespace {

using Eigen::Vector3d;

/// The side of an upright prism as one surface that faces outwards.
Scene prism(int sides) {
  Scene scene = SceneBuilder()
                    .square({.reflectance = 0.5f, .one_sided = true}, {0, 0, -5}, {0, 0, 1}, 1)
                    .build();
  PolygonMesh mesh;
  for (int i = 0; i < sides; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / sides;
    mesh.vertices.emplace_back(std::cos(angle), std::sin(angle), 0.0);
    mesh.vertices.emplace_back(std::cos(angle), std::sin(angle), 2.0);
    const int next = (i + 1) % sides;
    mesh.facets.push_back({.boundary = {2 * i, 2 * next, 2 * next + 1, 2 * i + 1}});
  }
  scene.surfaces[0].shape = std::move(mesh);
  return scene;
}

std::vector<LightmapChart> charts_of(const Scene& scene, double patch_size) {
  TracedScene lit(scene, patch_size);
  lit.set_direct([](const Vector3d&) { return 1.0f; });
  const SolvedScene solved{lit.mesh, lit.solution};
  const BakedModel model = bake_model(solved, scene);
  return cut_charts(model, solved.mesh, 1e-3);
}

/// Sides at 15 degrees to each other share no vertices, since their light differs; but a side and
/// its two neighbours make one chart. So 24 sides make 8 charts, or a few more if neighbours of the
/// last sides are in charts already.
TEST(LightmapCharts, SidesOfAColumnThatMeetBluntlyShareOne) {
  const auto charts = charts_of(prism(24), 0.5);
  EXPECT_GE(charts.size(), 8u);
  EXPECT_LE(charts.size(), 12u);
}

/// Sharp creases, here of 60 degrees, separate charts.
TEST(LightmapCharts, SharpCreasesPartThem) {
  EXPECT_EQ(charts_of(prism(6), 0.5).size(), 6u);
}

/// The chart of a plane surface is isometric, and a rectangle fills its chart.
TEST(LightmapCharts, PlanesKeepTheirLengths) {
  const Vector3d x = Vector3d(3, 1, 2).normalized(), y = Vector3d(-1, 3, 0).normalized();
  const Scene scene =
      SceneBuilder()
          .polygon({.reflectance = 0.5f, .one_sided = true}, {0 * x, 2 * x, 2 * x + 1 * y, 1 * y})
          .build();
  const auto charts = charts_of(scene, 0.4);
  ASSERT_EQ(charts.size(), 1u);
  // Sums and products of a few numbers of size one in double precision.
  EXPECT_NEAR(charts[0].size.x(), 2.0, 1e-13);
  EXPECT_NEAR(charts[0].size.y(), 1.0, 1e-13);
  EXPECT_NEAR(charts[0].x_axis.cross(charts[0].y_axis).dot(x.cross(y)), 1.0, 1e-13);
}

}  // namespace
}  // namespace lightwell::lightmap_charts_test
