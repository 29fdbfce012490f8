#include "mesh/patch_mesh.h"

#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <numbers>

#include "mesh_scenes.h"
#include "scene/errors.h"
#include "scene/parallel.h"

namespace lightwell {
namespace {

using namespace lightwell::testing;
using Eigen::Vector3d;

void expect_facet_areas(const Scene& scene, const PatchMesh& mesh) {
  const auto facets = scene_facets(scene);
  for (int f = 0; f < static_cast<int>(facets.size()); ++f) {
    const Surface& surface = scene.surfaces[facets[f].surface];
    const auto* polygons = std::get_if<PolygonMesh>(&surface.shape);
    if (!polygons) continue;
    const double area = facet_area(*polygons, polygons->facets[facets[f].facet]);
    // 1e-12: rounding of a sum of some thousand areas.
    EXPECT_NEAR(side_area(mesh, f, false), area, 1e-12 * area) << surface.name;
  }
}

TEST(PatchMesh, CornellBoxIsCoveredExactlyAndConforms) {
  const Scene scene = cornell_box();
  for (const double size : {0.1, 0.05, 0.031}) {
    const PatchMesh mesh = build_patches(scene, {.max_patch_size = size});
    expect_consistent(mesh);
    expect_facet_areas(scene, mesh);
    EXPECT_EQ(hanging_vertices(mesh), 0);
    std::printf("cornell size %g: %d patches %d elements %d vertices, smallest angle %.1f\n", size,
                mesh.patch_count(), mesh.element_count(), mesh.vertex_count(),
                smallest_angle(mesh));
  }
}

}  // namespace
}  // namespace lightwell
