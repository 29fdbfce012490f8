#include "radiosity/importance/importance.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "../parts/part_scenes.h"
#include "radiosity/parts/find_parts.h"
#include "radiosity/solve.h"
#include "scene/parallel.h"
#include "scene/sampling.h"

namespace lightwell::importance_test {
namespace {

using namespace test;

// Rays in all directions from an eye.
std::vector<Ray> rays_from(const Eigen::Vector3d& eye, int count = 4096) {
  std::vector<Ray> rays;
  const SobolPoints sobol(count);
  for (int i = 0; i < count; ++i) {
    const Eigen::Array4d u = sobol.point(i, 0).cast<double>();
    const double z = 2.0 * u[0] - 1.0, r = std::sqrt(std::max(0.0, 1.0 - z * z)),
                 angle = 2.0 * M_PI * u[1];
    rays.push_back({.origin = eye, .direction = {r * std::cos(angle), r * std::sin(angle), z}});
  }
  return rays;
}

// All patches alike.
std::vector<float> even(const PatchMesh& mesh) {
  return std::vector<float>(static_cast<std::size_t>(mesh.patch_count()), 1.0f);
}

const Eigen::Vector3d in_bright{1.0, 1.0, 1.5}, in_dim{6.0, 2.5, 1.5};

TEST(Importance, IsOneWhereViewRaysEnd) {
  const Scene scene = bright_and_dim(0.9);
  const PatchMesh mesh = build_patches(scene);
  const ElementCaster caster(mesh);
  const LightPaths paths(scene, caster, 8);
  const std::vector<Ray> rays = rays_from(in_bright);
  const std::vector<float> importance = find_importance(caster, paths, {}, rays, even(mesh));
  std::vector<ElementHit> hits(rays.size());
  caster.closest_elements(rays, hits);
  std::vector<char> is_seen(mesh.patch_count(), 0);
  for (const ElementHit& hit : hits) {
    if (hit.element >= 0) is_seen[mesh.patch[hit.element]] = 1;
  }
  int unseen = 0;
  for (int p = 0; p < mesh.patch_count(); ++p) {
    if (is_seen[p] != 0) {
      EXPECT_EQ(importance[p], 1.0f);
    } else {
      ++unseen;
      EXPECT_LE(importance[p], most_unseen_importance);
      EXPECT_GE(importance[p], least_importance);
    }
  }
  EXPECT_GT(unseen, 0);
}

// Mean importance of the room of a name, by area.
double mean_importance(const Scene& scene, const std::string& room, const Eigen::Vector3d& eye,
                       float brightness_of_room) {
  const PatchMesh mesh = build_patches(scene);
  const ElementCaster caster(mesh);
  const LightPaths paths(scene, caster, 8);
  std::vector<float> brightness = even(mesh);
  for (int p = 0; p < mesh.patch_count(); ++p) {
    if (scene.surfaces[mesh.surface[p]].name == room) brightness[p] = brightness_of_room;
  }
  const SceneParts parts = find_parts(scene, caster, paths);
  const std::vector<float> importance =
      find_importance(caster, paths, parts, rays_from(eye, 1 << 14), brightness);
  double sum = 0.0, area = 0.0;
  for (int p = 0; p < mesh.patch_count(); ++p) {
    if (scene.surfaces[mesh.surface[p]].name != room) continue;
    sum += mesh.area[p] * double{importance[p]};
    area += mesh.area[p];
  }
  return sum / area;
}

TEST(Importance, FallsBehindADoor) {
  // Through a slit of 0.05 m x 2 m one view ray of a thousand comes to the dim room. Single patches
  // beside the slit may matter, the room does not.
  const Scene scene = bright_and_dim(0.05);
  EXPECT_LT(mean_importance(scene, "dim", in_bright, 1.0f), 0.05);
  EXPECT_EQ(mean_importance(scene, "bright", in_bright, 1.0f), 1.0);
}

TEST(Importance, OfABrightRoomIsOneThoughFewWalksComeThere) {
  const Scene scene = bright_and_dim(0.05);
  EXPECT_LT(mean_importance(scene, "bright", in_dim, 1.0f), 0.05);
  EXPECT_EQ(mean_importance(scene, "bright", in_dim, 1000.0f), 1.0);
}

TEST(Importance, IsOneEverywhereIfNothingIsSeen) {
  const Scene scene = bright_and_dim(0.9);
  const PatchMesh mesh = build_patches(scene);
  const ElementCaster caster(mesh);
  const LightPaths paths(scene, caster, 8);
  const Ray away{.origin = {100, 0, 0}, .direction = {1, 0, 0}};
  const std::vector<float> importance = find_importance(caster, paths, {}, {&away, 1}, even(mesh));
  EXPECT_EQ(std::ranges::count(importance, 1.0f), mesh.patch_count());
}

TEST(Importance, IsTheSameForAnyNumberOfThreads) {
  const Scene scene = bright_and_dim(0.9);
  const PatchMesh mesh = build_patches(scene);
  const ElementCaster caster(mesh);
  const LightPaths paths(scene, caster, 8);
  const std::vector<float> of_many =
      find_importance(caster, paths, {}, rays_from(in_dim), even(mesh));
  const ThreadLimit one(1);
  EXPECT_EQ(find_importance(caster, paths, {}, rays_from(in_dim), even(mesh)), of_many);
}

// RMS difference of two solutions over the patches that are seen, relative to the reference's mean.
double error_where_seen(const SolvedScene& solved, const std::vector<float>& importance,
                        const SolvedScene& reference) {
  const ElementCaster caster(reference.mesh);
  const BandArray E = solved.solution.irradiance(), truth = reference.solution.irradiance();
  double square = 0.0, mean = 0.0, area = 0.0;
  for (int e = 0; e < solved.mesh.element_count(); ++e) {
    const int p = solved.mesh.patch[e];
    if (importance[p] < 1.0f || !(solved.mesh.reflectance(p, 0) > 0.0f)) continue;
    const PatchPoint at = element_center(solved.mesh, e);
    const Ray ray{.origin = at.position + 1e-4 * at.normal, .direction = -at.normal, .t_max = 1e-3};
    ElementHit hit;
    caster.closest_hits({&ray, 1}, {&hit, 1});
    if (hit.element < 0) continue;
    double own = 0.0;
    const int n = solved.mesh.corner_count(e);
    for (int c = 0; c < n; ++c) own += double{E(solved.mesh.corners[e][c], 0)} / n;
    const double right = double{interpolate(reference.mesh, truth, hit)[0]};
    square += solved.mesh.element_area[e] * (own - right) * (own - right);
    mean += solved.mesh.element_area[e] * right;
    area += solved.mesh.element_area[e];
  }
  return std::sqrt(square / area) / (mean / area);
}

TEST(Importance, SavesEffortAndKeepsTheErrorWhereSomebodyLooks) {
  const Scene scene = three_rooms();
  constexpr double accuracy = 0.08;
  SolveOptions options{.accuracy = Accuracy{.share = accuracy}};
  SolveReport of_all, of_seen;
  const SolvedScene all = solve_scene(scene, options, &of_all);
  options.view_rays = rays_from(in_bright);
  const SolvedScene seen = solve_scene(scene, options, &of_seen);
  EXPECT_LE(seen.solution.error_estimate, accuracy);
  EXPECT_LT(of_seen.refinement.gathers, of_all.refinement.gathers);
  EXPECT_LT(seen.mesh.element_count(), all.mesh.element_count());
  // The third room, of which nothing is seen, is not refined for its own sake.
  const auto in_third_room = [&](const SolvedScene& solved) {
    int count = 0;
    for (int e = 0; e < solved.mesh.element_count(); ++e) {
      count += scene.surfaces[solved.mesh.surface[solved.mesh.patch[e]]].name == "third" ? 1 : 0;
    }
    return count;
  };
  EXPECT_LT(in_third_room(seen), in_third_room(all));
  // Against a solution with half of the error; both errors together are at most 1.12 times the
  // larger.
  options.view_rays.clear();
  options.accuracy->share = accuracy / 2.0;
  const SolvedScene reference = solve_scene(scene, options);
  EXPECT_LT(error_where_seen(seen, seen.solution.parts.importance, reference), 1.12 * accuracy);
}

}  // namespace
}  // namespace lightwell::importance_test
