#include "radiosity/start_radiosity.h"

#include <gtest/gtest.h>

#include "mesh/build_patches.h"
#include "scene/errors.h"
#include "tests/radiosity/two_lamps.h"

namespace lightwell::start_radiosity_test {
namespace {

SolveOptions jacobi() {
  SolveOptions options = test::exact_and_even();
  options.solver_method = SolverMethod::jacobi;
  options.solver.tolerance = 1e-5;
  return options;
}

TEST(StartRadiosity, OfTheSameSceneLeavesNothingToDo) {
  const Scene scene = test::two_lamps();
  SolveOptions options = jacobi();
  const SolvedScene first = solve_scene(scene, options);
  options.start = &first;
  const SolvedScene again = solve_scene(scene, options);
  EXPECT_GT(first.solution.history.size(), 5u);
  EXPECT_LE(again.solution.history.size(), 2u);
}

// The error of Jacobi iteration falls by about the mean reflectance a sweep. A start that is off by
// a tenth of the reflected light, instead of by all of it, saves the sweeps for that factor.
TEST(StartRadiosity, OfOtherReflectancesSavesSweeps) {
  test::TwoLamps is;
  const SolvedScene old = solve_scene(test::two_lamps(is), jacobi());
  is.reflectance = 0.65f;
  const SolvedScene cold = solve_scene(test::two_lamps(is), jacobi());
  SolveOptions options = jacobi();
  options.start = &old;
  const SolvedScene warm = solve_scene(test::two_lamps(is), options);
  EXPECT_LT(warm.solution.history.size() + 2, cold.solution.history.size());
  // Both solutions are within the tolerance, relative to the largest B, of the exact one.
  const double largest = cold.solution.patch_radiosity.maxCoeff();
  EXPECT_LE((warm.solution.patch_radiosity - cold.solution.patch_radiosity).abs().maxCoeff(),
            2e-5 * largest);
}

TEST(StartRadiosity, ElementsMayBeRefined) {
  const Scene scene = test::two_lamps();
  SolveOptions options = jacobi();
  options.refine.tolerance = 0.02;
  const SolvedScene refined = solve_scene(scene, options);
  MeshOptions coarse = options.mesh;
  coarse.to_be_refined = true;
  const PatchMesh mesh = build_patches(scene, coarse);
  ASSERT_LT(mesh.element_count(), refined.mesh.element_count());
  EXPECT_TRUE((start_radiosity(mesh, refined) == refined.solution.patch_radiosity).all());
}

TEST(StartRadiosity, ChannelsOfTheSameNamesStartFromTheirOwn) {
  const Scene scene = test::two_lamps();
  SolveOptions options = jacobi();
  options.channels = channels_per_luminaire(scene);
  const SolvedScene first = solve_scene(scene, options);
  EXPECT_EQ(start_by_channel(&first, options.channels).cols(), 6);
  EXPECT_EQ(start_by_channel(&first, {.names = {"panel", "desk"}}).size(), 0);
  EXPECT_EQ(start_by_channel(nullptr, options.channels).size(), 0);
  options.start = &first;
  const SolvedScene again = solve_scene(scene, options);
  EXPECT_LE((again.solution.patch_radiosity - first.solution.patch_radiosity).abs().maxCoeff(),
            2e-5 * first.solution.patch_radiosity.maxCoeff());
}

TEST(StartRadiosity, OtherPatchesAreRefused) {
  const Scene scene = test::two_lamps();
  const SolvedScene old = solve_scene(scene, jacobi());
  MeshOptions mesh = jacobi().mesh;
  Scene moved = scene;
  for (auto& vertex : std::get<PolygonMesh>(moved.surfaces.back().shape).vertices) {
    vertex.x() += 1e-3;
  }
  EXPECT_THROW(start_radiosity(build_patches(moved, mesh), old), InputError);
  mesh.max_patch_size = 0.2;
  EXPECT_THROW(start_radiosity(build_patches(scene, mesh), old), InputError);
}

}  // namespace
}  // namespace lightwell::start_radiosity_test
