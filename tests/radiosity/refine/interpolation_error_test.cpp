#include "radiosity/refine/interpolation_error.h"

#include <gtest/gtest.h>

#include "radiosity/solve.h"
#include "tests/radiosity/test_scenes.h"

namespace lightwell::interpolation_error_test {
namespace {

using Eigen::Vector3d;

// A room of 4 x 4 x 3 m without a roof, under a uniform sky. Nothing but the straight upper edges
// of the walls hides sky, so light varies over metres.
Scene roofless_room() {
  Scene scene;
  const int grey = test::add_material(scene, test::diffuse(scene.bands, 0.5f));
  test::add_polygon(scene, "floor", grey, {{0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {0, 4, 0}});
  test::add_polygon(scene, "front", grey, {{0, 0, 0}, {0, 0, 3}, {4, 0, 3}, {4, 0, 0}});
  test::add_polygon(scene, "right", grey, {{4, 0, 0}, {4, 0, 3}, {4, 4, 3}, {4, 4, 0}});
  test::add_polygon(scene, "back", grey, {{4, 4, 0}, {4, 4, 3}, {0, 4, 3}, {0, 4, 0}});
  test::add_polygon(scene, "left", grey, {{0, 4, 0}, {0, 4, 3}, {0, 0, 3}, {0, 0, 0}});
  scene.sky = test::even_sky(scene.bands, 1.0f, 0.2f);
  return scene;
}

TEST(InterpolationError, NoiseOfTheSkyIsNotSplit) {
  const Scene scene = roofless_room();
  SolveOptions options{.accuracy = Accuracy{.share = 0.01}};
  options.mesh.max_patch_size = 0.5;
  const SolvedScene solved = solve_scene(scene, options);
  EXPECT_EQ(solved.solution.outcome, Outcome::converged);
  EXPECT_LE(solved.solution.error_estimate, 0.01);
  // Both sides of 16 m2 and of four walls of 12 m2 in elements of 0.25 m2: 512. Two levels of
  // splits all over would leave a sixteenth of the error, three are a waste: 512 * 4^3 = 32768.
  EXPECT_LT(solved.mesh.element_count(), 32768);
}

}  // namespace
}  // namespace lightwell::interpolation_error_test
