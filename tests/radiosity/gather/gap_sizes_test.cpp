#include "radiosity/gather/gap_sizes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "mesh/build_patches.h"
#include "tests/radiosity/test_scenes.h"

namespace lightwell::gap_sizes_test {
namespace {

// A square of 2 m, and a strip that bends by a degree from facet to facet, of 0.1 x 0.1 m each.
Scene square_and_strip() {
  Scene scene;
  Material both_sides = test::diffuse(scene.bands, 0.5f);
  both_sides.one_sided = false;
  const int sheet = test::add_material(scene, both_sides);
  test::add_polygon(scene, "square", sheet, {{0, 0, 0}, {2, 0, 0}, {2, 2, 0}, {0, 2, 0}});
  PolygonMesh strip;
  double x = 0.0, z = 1.0;
  constexpr int n = 8;
  constexpr double side = 0.1;
  for (int i = 0; i <= n; ++i) {
    strip.vertices.push_back({x, 0.0, z});
    strip.vertices.push_back({x, side, z});
    const double slope = i * std::numbers::pi / 180.0;
    x += side * std::cos(slope);
    z += side * std::sin(slope);
  }
  for (int i = 0; i < n; ++i) {
    strip.facets.push_back({{2 * i, 2 * i + 2, 2 * i + 3, 2 * i + 1}});
  }
  scene.surfaces.push_back({.name = "strip", .material = sheet, .shape = std::move(strip)});
  return scene;
}

TEST(GapSizes, AreThoseOfPatchesOrOfTwoFacets) {
  constexpr double patch_size = 0.5;
  const Scene scene = square_and_strip();
  const PatchMesh mesh = build_patches(scene, {.max_patch_size = patch_size});
  const std::vector<float> sizes = gap_sizes(mesh);
  ASSERT_EQ(static_cast<int>(sizes.size()), mesh.element_count());
  int of_strip = 0;
  for (int e = 0; e < mesh.element_count(); ++e) {
    const int p = mesh.patch[e];
    const bool is_strip = scene.surfaces[mesh.surface[p]].name == "strip";
    // Patches of the strip reach over several facets, whose two sides count apart.
    if (is_strip) EXPECT_GT(mesh.area[p], 4.0 * 0.1 * 0.1 * (1.0 - 1e-9));
    EXPECT_NEAR(sizes[e], is_strip ? 2.0 * 0.1 : patch_size, 1e-6) << e;
    of_strip += is_strip ? 1 : 0;
  }
  EXPECT_GT(of_strip, 0);
}

}  // namespace
}  // namespace lightwell::gap_sizes_test
