#include "radiosity/reconstruct.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <set>
#include <vector>

#include "mesh/build_patches.h"
#include "radiosity/gather/vertex_points.h"
#include "radiosity/refine/gather_noise.h"
#include "radiosity/refine/interpolated_vertices.h"
#include "tests/radiosity/two_lamps.h"

namespace lightwell::reconstruct_test {
namespace {

// A room with solved patches, for pilot gathers.
struct Room {
  Scene scene = test::two_lamps();
  SolveOptions options{};
  SolvedScene patches{};

  explicit Room(double tolerance) {
    options.mesh = {.max_patch_size = 0.35, .to_be_refined = true};
    options.gather = {.rays = 128, .shadows = {.min_rays = 16, .max_rays = 64}};
    options.refine = {.tolerance = tolerance, .max_elements = 1000000};
    patches.mesh = build_patches(scene, options.mesh);
    const ElementCaster caster(patches.mesh);
    const auto form_factors = compute_form_factors(
        {scene, caster, DirectLight(scene, patches.mesh)}, {.rays_per_patch = 128});
    patches.solution =
        solve_radiosity(SolverMethod::automatic, patches.mesh, *form_factors, options.solver);
  }
};

TEST(InterpolatedVertices, AreMeansOfTheirEnds) {
  BandArray values(5, 1);
  values << 1.0f, 3.0f, 100.0f, 5.0f, 100.0f;
  const std::vector<InterpolatedVertex> interpolated{{.vertex = 2, .ends = {0, 1, -1, -1}},
                                                     {.vertex = 4, .ends = {0, 1, 2, 3}}};
  interpolate_vertices(interpolated, values);
  EXPECT_FLOAT_EQ(values(2, 0), 2.0f);
  EXPECT_FLOAT_EQ(values(4, 0), 2.75f);
}

// Two ends of 2 and 4, and between them a vertex whose gather is 9 with a variance of 8. The pilot
// gather has 10 and 12 at the ends and 13 between them, two above their mean.
class BetweenTwo : public testing::Test {
 protected:
  void join(float spread, float noise, bool is_interpolated = false) {
    values.resize(3, 1);
    values << 2.0f, 4.0f, 9.0f;
    variance.resize(3);
    variance << 1.0f, 1.0f, 8.0f;
    BandArray pilot(3, 1);
    pilot << 10.0f, 12.0f, 13.0f;
    const std::vector<VertexPrediction> between{{.at = {.vertex = 2, .ends = {0, 1, -1, -1}},
                                                 .is_interpolated = is_interpolated,
                                                 .spread = spread,
                                                 .noise = noise}};
    combine_with_predictions(between, pilot, group, 1, values, variance);
    EXPECT_EQ(values(0, 0), 2.0f);
    EXPECT_EQ(values(1, 0), 4.0f);
  }

  std::vector<int> group{0, 0, 0};
  BandArray values;
  Eigen::ArrayXf variance;
};

TEST_F(BetweenTwo, WhatAPilotGatherKnowsWellCountsByHowSureItIs) {
  // An exact difference predicts 3 + 2 with the ends' variance of 1. The prediction is off by 4,
  // and 8 + 2/4 of the square are explained, so 7.5 are not.
  join(4.0f, 0.0f);
  const float predicted = 1.0f + 7.5f, share = 8.0f / (8.0f + predicted);
  EXPECT_FLOAT_EQ(values(2, 0), 9.0f + share * (5.0f - 9.0f));
  EXPECT_FLOAT_EQ(variance[2], 8.0f * (1.0f - share));
}

TEST_F(BetweenTwo, ADifferenceLostInNoiseIsShrunk) {
  // The weight of the difference is a half: the prediction is 3 + 1, with a variance of 1 + 0.5 * 4
  // and an unexplained square of 25 - (8 + 0.5 + 2).
  join(4.0f, 4.0f);
  const float predicted = 1.0f + 2.0f + 14.5f, share = 8.0f / (8.0f + predicted);
  EXPECT_FLOAT_EQ(values(2, 0), 9.0f + share * (4.0f - 9.0f));
}

TEST_F(BetweenTwo, AnUnmeasuredVertexIsLeftAndAnInterpolatedOneIsTheMean) {
  join(std::numeric_limits<float>::infinity(), std::numeric_limits<float>::infinity());
  EXPECT_EQ(values(2, 0), 9.0f);
  EXPECT_EQ(variance[2], 8.0f);
  join(1.0f, 1.0f, true);
  EXPECT_EQ(values(2, 0), 3.0f);
}

TEST(InterpolatedVertices, GiveTheirAreaToTheirEnds) {
  Scene scene;
  const int grey = test::add_material(scene, test::diffuse(scene.bands, 0.5f, 1.0f));
  test::add_box(scene, {0, 0, 0}, {1, 1, 1}, {grey, grey, grey, grey, grey, grey}, true);
  const PatchMesh mesh =
      build_patches(scene, {.max_patch_size = 1.0, .elements_per_patch_edge = 2});
  const std::vector<double> area = vertex_areas(mesh);
  double sum = 0.0;
  for (const double a : area) sum += a;
  EXPECT_NEAR(sum, 6.0, 1e-12);  // a few roundings of each of 24 elements
  std::vector<InterpolatedVertex> interpolated;
  for (int v = 1; v < mesh.vertex_count(); ++v) interpolated.push_back({v, {0, 0, -1, -1}});
  const std::vector<int> rays = share_rays(mesh, interpolated, {}, std::vector<int>{64});
  EXPECT_EQ(rays[0], 64);  // all of the area is as large as the typical one
  for (std::size_t v = 1; v < rays.size(); ++v) EXPECT_EQ(rays[v], 0);
}

// A finer pilot gather has the vertices of the coarser one, with the same numbers and the same
// light, and takes no more gathers than one made at once. (An exception are the few vertices that
// close elements against finer neighbours, and vanish when the elements themselves are split.)
TEST(PilotGathers, GoesOnWhereItEnded) {
  Room room(0.03);
  const DirectLight direct_light(room.scene, room.patches.mesh);
  PilotGathers pilot_gathers(room.scene, room.patches.mesh, direct_light, room.patches.solution);
  const PilotGather coarse = pilot_gathers.gather(room.options).value();
  room.options.refine.tolerance = 0.01;
  const PilotGather fine = pilot_gathers.gather(room.options).value();
  PilotGathers at_once(room.scene, room.patches.mesh, direct_light, room.patches.solution);
  const PilotGather other = at_once.gather(room.options).value();
  ASSERT_TRUE(coarse.refined && fine.refined && other.refined);
  std::printf("%d elements with %lld gathers, %d with %lld; at once %d with %lld\n",
              coarse.refined->element_count(), static_cast<long long>(coarse.refinement.gathers),
              fine.refined->element_count(), static_cast<long long>(fine.refinement.gathers),
              other.refined->element_count(), static_cast<long long>(other.refinement.gathers));
  EXPECT_LE(coarse.refinement.estimate, 0.03);
  EXPECT_LE(fine.refinement.estimate, 0.01);
  EXPECT_GT(fine.refined->element_count(), coarse.refined->element_count());
  EXPECT_EQ(fine.refinement.elements_at_first, other.refinement.elements_at_first);
  // The rounds decide which cells are split when: a tenth either way.
  EXPECT_LT(fine.refinement.gathers, 1.1 * static_cast<double>(other.refinement.gathers));

  std::vector<int> place(
      static_cast<std::size_t>(*std::max_element(fine.number.begin(), fine.number.end())) + 1, -1);
  for (std::size_t v = 0; v < fine.number.size(); ++v) {
    place[static_cast<std::size_t>(fine.number[v])] = static_cast<int>(v);
  }
  std::size_t gone = 0;
  for (std::size_t v = 0; v < coarse.number.size(); ++v) {
    const auto number = static_cast<std::size_t>(coarse.number[v]);
    if (number >= place.size() || place[number] < 0) {
      EXPECT_GE(coarse.number[v], room.patches.mesh.vertex_count());
      ++gone;
      continue;
    }
    const auto before = static_cast<Eigen::Index>(v),
               now = static_cast<Eigen::Index>(place[number]);
    EXPECT_TRUE((coarse.direct.row(before) == fine.direct.row(now)).all());
  }
  std::printf("%zu of %zu vertices gone\n", gone, coarse.number.size());
  EXPECT_LT(200 * gone, coarse.number.size());  // one in 1444 here
}

// Light without a pilot gather, for want of time. The visible share of a lamp by 8 shadow rays has
// a standard error of sqrt(1/4 / 8) at most, so light at vertices is no farther off. The light of a
// lamp close above a block changes within a patch by more, which one point of each patch misses.
TEST(PilotGathers, InHasteHaveDirectLightAtVerticesIfThereIsTime) {
  Room room(0.03);
  const DirectLight direct_light(room.scene, room.patches.mesh);
  PilotGathers pilots(room.scene, room.patches.mesh, direct_light, room.patches.solution);
  const ElementCaster caster(room.patches.mesh);
  const GatherOptions many{.shadows = {.min_rays = 256, .max_rays = 1024}};
  const BandArray exact =
      gather_direct({room.scene, caster, direct_light}, vertex_points(caster), many);
  const auto error = [&](double seconds_left) {
    room.options.run.seconds_left = [=] { return seconds_left; };
    const BandArray off = pilots.gather_in_haste(room.options).direct - exact;
    return std::sqrt(off.square().mean() / exact.square().mean());
  };
  const float at_vertices = error(1e6), of_patches = error(0.0);
  std::printf("direct light at vertices %.1f %% off, of patches %.1f %%\n",
              100.0 * double{at_vertices}, 100.0 * double{of_patches});
  const float noise_of_few = std::sqrt(0.25f / 8.0f);
  EXPECT_LT(at_vertices, noise_of_few);
  EXPECT_GT(of_patches, noise_of_few) << "the test tells vertices from patches";
}

// Interpolated vertices lie between their ends, which are vertices of the mesh and come first if
// they are interpolated themselves.
TEST(PilotGathers, InterpolatesIndirectLightFromVerticesOfTheMesh) {
  Room room(0.02);
  room.options.gather.rays = 2048;
  const DirectLight direct_light(room.scene, room.patches.mesh);
  PilotGathers pilot_gathers(room.scene, room.patches.mesh, direct_light, room.patches.solution);
  const PilotGather pilot = pilot_gathers.gather(room.options).value();
  ASSERT_TRUE(pilot.refined);
  std::printf("%zu of %d vertices are interpolated\n", pilot.interpolated.size(),
              pilot.refined->vertex_count());
  EXPECT_GT(pilot.interpolated.size(), 0u);
  std::set<int> still_to_come;
  for (const InterpolatedVertex& t : pilot.interpolated) still_to_come.insert(t.vertex);
  for (const InterpolatedVertex& t : pilot.interpolated) {
    Eigen::Vector3d mean = Eigen::Vector3d::Zero();
    for (int i = 0; i < t.end_count(); ++i) {
      EXPECT_FALSE(still_to_come.contains(t.ends[i]));
      mean += pilot.refined->position(t.ends[i]) / t.end_count();
    }
    still_to_come.erase(t.vertex);
    // Rounding of single precision in a room of 3 m.
    EXPECT_LT((mean - pilot.refined->position(t.vertex)).norm(), 1e-6);
  }
}

TEST(Reconstruct, AddsToWhatIsKept) {
  Room room(0.03);
  const DirectLight direct_light(room.scene, room.patches.mesh);
  PilotGathers pilot_gathers(room.scene, room.patches.mesh, direct_light, room.patches.solution);
  const PilotGather pilot = pilot_gathers.gather(room.options).value();
  const ElementCaster caster(*pilot.refined);
  KeptGathers kept;
  RadiositySolution solution = room.patches.solution;
  const auto gather = [&](int rays) {
    room.options.gather.rays = rays;
    reconstruct({room.scene, caster, direct_light}, room.options, pilot, solution, &kept);
    return BandArray(solution.indirect_irradiance);
  };
  const BandArray first = gather(64);
  const double noise = rms_noise(*pilot.refined, solution.gather_noise);
  EXPECT_TRUE((gather(64) == first).all());  // no ray is missing
  const BandArray second = gather(128);
  EXPECT_FALSE((second == first).all());
  // Two independent gathers of 64 rays leave half of the variance, known from some 1000 vertices to
  // a few percent.
  const double left = rms_noise(*pilot.refined, solution.gather_noise) / noise;
  std::printf("noise of twice the rays: %.3f of that of once\n", left);
  EXPECT_NEAR(left, std::sqrt(0.5), 0.07);
}

// In a closed grey room reflections bring rho / (1 - rho) times the power of a lamp, wherever its
// light falls: here into a pool of 0.4 m on a floor with patches of 0.25 to 0.5 m, so that the pool
// lies between vertices or on one of them. The pool's light must neither be lost, nor be reflected
// by other surfaces, nor fill a whole patch.
class Pool : public testing::TestWithParam<double> {};

TEST_P(Pool, GivesTheRoomItsLight) {
  Scene scene;
  constexpr float rho = 0.5f;
  const int grey = test::add_material(scene, test::diffuse(scene.bands, rho));
  test::add_box(scene, {0, 0, 0}, {4, 4, 3}, {grey, grey, grey, grey, grey, grey}, true);
  scene.lamps.push_back({.name = "spot",
                         .position = {1.7, 1.9, 2.5},
                         .intensity = constant_spectrum(scene.bands, 100.0f),
                         .shape = SpotCone{.inner = 0.06, .outer = 0.08}});
  SolveOptions options;
  options.mesh.max_patch_size = GetParam();
  const SolvedScene solved = solve_scene(scene, options);
  const PatchMesh& mesh = solved.mesh;
  const BandArray E = element_mean(mesh, solved.solution.indirect_irradiance);
  double indirect = 0.0, on_floor = 0.0;  // W
  for (int e = 0; e < mesh.element_count(); ++e) {
    const double power = mesh.element_area[e] * double{E(e, 0)};
    indirect += power;
    if (element_center(mesh, e).normal.z() > 0.5) on_floor += power;
  }
  const double wanted = lamp_flux(scene.lamps[0])[0] * rho / (1.0 - rho);
  std::printf("indirect %.4f W of %.4f, %.4f of them on the floor; error %.3f estimated\n",
              indirect, wanted, on_floor, solved.solution.error_estimate);
  // Refinement leaves 0.7 % of the mean irradiance.
  EXPECT_NEAR(indirect, wanted, 0.01 * wanted);
  // Indirect light of the floor, from walls and ceiling: 0.1563 W with 7588 elements of patches of
  // 0.12 m.
  EXPECT_NEAR(on_floor, 0.1563, 0.01 * 0.1563);
}
INSTANTIATE_TEST_SUITE_P(Sizes, Pool, testing::Values(0.25, 0.4, 0.5));

}  // namespace
}  // namespace lightwell::reconstruct_test
