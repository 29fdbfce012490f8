#include <gtest/gtest.h>

#include <cstdio>

#include "light_tracer.h"
#include "part_scenes.h"
#include "radiosity/refine/error_reference.h"
#include "radiosity/solve.h"

namespace lightwell::part_accuracy_test {
namespace {

using namespace test;

// The part that surfaces of a name are in.
int part_of(const Scene& scene, const SolvedScene& solved, const std::string& name) {
  for (int p = 0; p < solved.mesh.patch_count(); ++p) {
    if (scene.surfaces[solved.mesh.surface[p]].name == name) {
      return solved.solution.parts.of_patch[p];
    }
  }
  return -1;
}

// Relative errors of each part's mean are below the accuracy, and the tracer's own error: of
// 400 000 paths, of which few reach the dim room.
void expect_traced_means(const SolvedScene& solved, double accuracy, double noise) {
  const ElementCaster caster(solved.mesh);
  constexpr int paths = 400000;
  const SceneParts& parts = solved.solution.parts;
  int emitters = 0;
  for (int p = 0; p < solved.mesh.patch_count(); ++p) {
    emitters += solved.mesh.emission(p, 0) > 0.0f;
  }
  const std::vector<double> traced = traced_means(caster, parts, paths / emitters);
  const PartMeans means = part_means(solved.mesh, solved.solution.irradiance(), parts);
  for (int p = 0; p < parts.count(); ++p) {
    EXPECT_NEAR(means.of_part(p) / traced[p], 1.0, accuracy + noise) << parts.parts[p].name;
  }
}

TEST(PartAccuracy, HoldsInARoomBehindADoor) {
  // A slit of 0.3 m x 2 m: the dim room has a fiftieth of the bright room's light.
  Scene scene = bright_and_dim(0.3);
  turn(scene, 0.4, {1, 2, 3});
  constexpr double accuracy = 0.08;
  const SolvedScene solved = solve_scene(scene, {.accuracy = Accuracy{.share = accuracy}});
  ASSERT_EQ(solved.solution.parts.count(), 2);
  EXPECT_EQ(solved.solution.outcome, Outcome::converged);
  for (const ScenePart& part : solved.solution.parts.parts) {
    EXPECT_GT(part.error_estimate, 0.0) << part.name;
    EXPECT_LE(part.error_estimate, accuracy) << part.name;
    EXPECT_LE(part.error_estimate, solved.solution.error_estimate) << part.name;
  }
  // About 4000 paths pass the slit, and their light is reflected one and a half times: 2 % twice.
  expect_traced_means(solved, accuracy, 0.05);
}

TEST(PartAccuracy, ADimRoomThatIsOffIsSaid) {
  // Without refinement and with few rays, the dim room is off by far more of its own light than the
  // bright room, and no attempt may mend that.
  Scene scene = bright_and_dim(0.1);
  const SolvedScene solved =
      solve_scene(scene, {.gather = {.rays = 64}, .refine = {.tolerance = 0.0}});
  ASSERT_EQ(solved.solution.parts.count(), 2);
  const auto& parts = solved.solution.parts.parts;
  const double dim = parts[part_of(scene, solved, "dim")].error_estimate,
               bright = parts[part_of(scene, solved, "bright")].error_estimate;
  EXPECT_GT(dim, 3.0 * bright);
  EXPECT_EQ(solved.solution.error_estimate, std::max(dim, bright));
}

TEST(PartAccuracy, ADarkPartHasNoEstimate) {
  Scene scene;
  Material two_sided = diffuse(scene.bands, 0.5f);
  two_sided.one_sided = false;
  const int m = add_material(scene, diffuse(scene.bands, 0.5f)),
            lamp = add_material(scene, diffuse(scene.bands, 0.5f, 10.0f)),
            board = add_material(scene, two_sided);
  add_box(scene, {0, 0, 0}, {4, 5, 3}, {m, m, m, m, m, lamp}, true);
  add_box(scene, {1.0, 1.0, 0.3}, {1.6, 1.6, 2.3}, {board, board, board, board, board, board},
          false);
  const SolvedScene solved = solve_scene(scene, {.accuracy = Accuracy{.share = 0.05}});
  ASSERT_EQ(solved.solution.parts.count(), 2);
  EXPECT_EQ(solved.solution.outcome, Outcome::converged);
  EXPECT_EQ(solved.solution.parts.parts[1].error_estimate, -1.0) << "not estimated";
  EXPECT_EQ(solved.solution.error_estimate, solved.solution.parts.parts[0].error_estimate);
}

TEST(PartAccuracy, OneRoomIsJudgedAsAWhole) {
  Scene scene;
  const int m = add_material(scene, diffuse(scene.bands, 0.5f)),
            lamp = add_material(scene, diffuse(scene.bands, 0.5f, 10.0f));
  add_box(scene, {0, 0, 0}, {4, 5, 3}, {m, m, m, m, m, lamp}, true);
  const SolvedScene solved = solve_scene(scene, {.accuracy = Accuracy{.share = 0.05}});
  ASSERT_EQ(solved.solution.parts.count(), 1);
  EXPECT_EQ(solved.solution.parts.parts[0].error_estimate, solved.solution.error_estimate);
  const BandArray E = solved.solution.irradiance();
  EXPECT_TRUE(
      (error_references(solved.mesh, E, solved.solution.parts) == error_references(solved.mesh, E))
          .all());
}

TEST(PartMeans, APartIsJudgedByATenThousandthOfTheBrightestAtLeast) {
  SceneParts parts{.of_patch = {0, 1, 2, -1}, .parts = std::vector<ScenePart>(3)};
  PartMeans means(parts);
  means.add(0, 2.0, 1000.0);
  means.add(1, 4.0, 1.0);
  means.add(2, 1.0, 1e-6);
  means.finish();
  EXPECT_EQ(means.of_patch(0), 1000.0);
  EXPECT_EQ(means.of_patch(1), 1.0);
  EXPECT_DOUBLE_EQ(means.of_patch(2), 0.1);
  EXPECT_EQ(means.of_patch(3), 1000.0) << "patches of no part are judged with the first";
}

TEST(PartMeans, TheInsideOfALampIsNotTheBrightestPart) {
  SceneParts parts{.of_patch = {0, 1, 2}, .parts = std::vector<ScenePart>(3)};
  PartMeans means(parts);
  means.add(0, 100.0, 1000.0);
  means.add(1, 1.0, 1e6);
  means.add(2, 100.0, 1e-6);
  means.finish();
  EXPECT_EQ(means.of_patch(1), 1e6);
  EXPECT_DOUBLE_EQ(means.of_patch(2), 0.1);
}

}  // namespace
}  // namespace lightwell::part_accuracy_test
