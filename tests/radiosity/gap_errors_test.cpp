#include "radiosity/gap_errors.h"

#include <gtest/gtest.h>

#include <cmath>

#include "mesh/build_patches.h"
#include "radiosity/refine/error_reference.h"
#include "tests/mesh/mesh_scenes.h"
#include "tests/radiosity/even_light.h"

namespace lightwell::gap_errors_test {
namespace {

/// A floor of 2 m x 2 m under a lamp as large, 1 m above, and a plate of 1 m x 1 m above the middle
/// of the floor at `height`.
Scene lamp_over_plate(double height) {
  Scene scene = test::empty_scene();
  const int lamp = test::add_lamp(scene);
  test::add_polygon(scene, "floor", {{0, 0, 0}, {2, 0, 0}, {2, 2, 0}, {0, 2, 0}});
  test::add_polygon(scene, "lamp", {{0, 0, 1}, {0, 2, 1}, {2, 2, 1}, {2, 0, 1}}, {}, lamp);
  test::add_polygon(
      scene, "plate",
      {{0.5, 0.5, height}, {1.5, 0.5, height}, {1.5, 1.5, height}, {0.5, 1.5, height}});
  return scene;
}

TEST(GapErrors, AreTheDifferenceFromDarknessInTheGapAlone) {
  // The gap is 16 % of an element wide, too wide for gap_lines(), and 4 % of a patch.
  const double height = 0.02;
  const Scene scene = lamp_over_plate(height);
  const PatchMesh mesh =
      build_patches(scene, {.max_patch_size = 0.5, .elements_per_patch_edge = 4});
  const ElementCaster caster(mesh);
  const DirectLight direct_light(scene, mesh);
  RadiositySolution solution = test::even_light(scene, mesh);
  add_gap_errors({scene, caster, direct_light}, {}, solution);
  int in_gap = 0;
  for (int e = 0; e < mesh.element_count(); ++e) {
    if (mesh.surface[mesh.patch[e]] != 0 || mesh.is_back[mesh.patch[e]] != 0) continue;
    const Eigen::Vector3d at = element_center(mesh, e).position;
    const double depth =
        0.5 - std::max(std::abs(at.x() - 1.0), std::abs(at.y() - 1.0));  // under the plate, m
    const float error = solution.interpolation_error[e];
    if (depth < -0.0625 - 1e-9) {
      EXPECT_EQ(error, 0.0f) << "open at " << at.transpose();
    }
    if (depth < 0.1) continue;
    ++in_gap;
    // The four points of an element lie at least 0.07 m under the plate, 3.4 times its height h. A
    // slit of height h at distance d has a form factor below (h / d)^2 / 4, here 0.02; there are
    // two at most, and floor and plate reflect no more than that into the depth. Interpolated light
    // is 1, and so is the reference.
    EXPECT_NEAR(error, 1.0f, 0.1f) << at.transpose();
  }
  EXPECT_GT(in_gap, 16);
}

TEST(GapErrors, LeaveOpenScenesAlone) {
  const Scene scene = lamp_over_plate(0.6);
  const PatchMesh mesh = build_patches(scene, {.max_patch_size = 0.5});
  const ElementCaster caster(mesh);
  RadiositySolution solution = test::even_light(scene, mesh);
  add_gap_errors({scene, caster, DirectLight(scene, mesh)}, {}, solution);
  EXPECT_TRUE((solution.interpolation_error == 0.0f).all());
}

}  // namespace
}  // namespace lightwell::gap_errors_test
