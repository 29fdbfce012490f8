#include "radiosity/solvers/progressive.h"

#include <gtest/gtest.h>

#include "mesh/build_patches.h"
#include "radiosity/gather/vertex_points.h"
#include "radiosity/paths/light_path.h"
#include "radiosity/solve.h"
#include "radiosity/solvers/solve_channels.h"
#include "radiosity/solvers/solve_radiosity.h"
#include "radiosity/solvers/vertex_light.h"
#include "scene/parallel.h"
#include "tests/radiosity/test_scenes.h"

namespace lightwell::progressive_test {
namespace {

using test::add_box;
using test::add_material;
using test::diffuse;

// A room with a lamp under its ceiling, a block, and optionally a mirror as one wall.
Scene lamp_room(float rho, bool with_mirror) {
  Scene scene;
  const int wall = add_material(scene, diffuse(scene.bands, rho));
  const int lamp = add_material(scene, diffuse(scene.bands, 0.0f, 10.0f));
  int side = wall;
  if (with_mirror) {
    Material mirror = diffuse(scene.bands, 0.2f);
    mirror.specular = constant_spectrum(scene.bands, 0.5f);
    side = add_material(scene, mirror);
  }
  add_box(scene, {0, 0, 0}, {2.0, 1.5, 1.0}, {side, wall, wall, wall, wall, wall}, true);
  add_box(scene, {0.5, 0.5, 0.9}, {0.9, 0.9, 1.0}, {wall, wall, wall, wall, lamp, wall}, false);
  add_box(scene, {1.2, 0.4, 0.0}, {1.6, 0.8, 0.4}, {wall, wall, wall, wall, wall, wall}, false);
  return scene;
}

struct Solved {
  explicit Solved(Scene s)
      : scene(std::move(s)),
        mesh(build_patches(scene, {.auto_patch_count = 300})),
        caster(mesh),
        direct_light(scene, mesh),
        paths(scene, caster, 8) {}

  std::unique_ptr<FormFactors> form_factors() const {
    return compute_form_factors({scene, caster, direct_light}, {});
  }
  Scene scene;
  PatchMesh mesh;
  ElementCaster caster;
  DirectLight direct_light;
  LightPaths paths;
};

void run(ProgressiveRadiosity& progressive) {
  while (progressive.step()) {
  }
}

double rms(const PatchMesh& mesh, const BandArray& a, const BandArray& b) {
  double squares = 0.0, all = 0.0;
  for (int i = 0; i < mesh.patch_count(); ++i) {
    squares += mesh.area[i] * (a.row(i) - b.row(i)).square().cast<double>().sum();
    all += mesh.area[i] * b.row(i).square().cast<double>().sum();
  }
  return std::sqrt(squares / all);
}

void expect_balanced(const EnergyBalance& energy, double tolerance) {
  EXPECT_NEAR(energy.absorbed + energy.escaped + energy.unshot, energy.emitted,
              tolerance * energy.emitted);
}

TEST(Progressive, ToTheEndIsWhatGaussSeidelFinds) {
  for (const bool with_mirror : {false, true}) {
    const Solved room(lamp_room(0.6f, with_mirror));
    const auto F = room.form_factors();
    const BandArray wanted =
        solve_radiosity(SolverMethod::automatic, room.mesh, *F, {.tolerance = 1e-7})
            .patch_radiosity;
    ProgressiveRadiosity progressive(room.scene, room.mesh, stored_shots(*F), {.tolerance = 1e-6});
    run(progressive);
    EXPECT_TRUE(progressive.has_converged());
    // Extended form factors are not reciprocal, so shooting and gathering along rows differ by the
    // sampling error, and energy closes as well as the assembly closed them. Without a mirror the
    // only difference is float rounding of many small additions.
    EXPECT_LT(rms(room.mesh, progressive.radiosity(), wanted), with_mirror ? 5e-3 : 1e-5);
    if (!with_mirror) expect_balanced(progressive.energy(), 1e-5);
  }
}

TEST(Progressive, RowsCastOnTheFlyFindTheSameLight) {
  const Solved room(lamp_room(0.6f, false));
  const auto F = room.form_factors();
  const BandArray wanted = solve_radiosity(SolverMethod::automatic, room.mesh, *F).patch_radiosity;
  constexpr int most_rays = 1 << 16;
  ProgressiveRadiosity progressive(room.scene, room.mesh,
                                   cast_shots(room.caster, room.paths, most_rays),
                                   {.rays = 1200000, .most_rays = most_rays});
  run(progressive);
  // One in 300 of 1.2 million rays arrives at a patch: 4000 rays, or 1.6 % if they were random.
  EXPECT_LT(rms(room.mesh, progressive.radiosity(), wanted), 0.016);
  expect_balanced(progressive.energy(), 1e-5);
}

TEST(Progressive, EnergyIsBalancedAfterEveryShotInAnOpenRoomToo) {
  Scene scene = lamp_room(0.5f, true);
  scene.surfaces.erase(scene.surfaces.begin() + 1);  // the wall x1
  const Solved room(scene);
  ProgressiveRadiosity progressive(room.scene, room.mesh, cast_shots(room.caster, room.paths, 4096),
                                   {.most_rays = 4096});
  double before = 2.0;
  for (int round = 0; round < 20; ++round) {
    expect_balanced(progressive.energy(), 1e-5);
    EXPECT_LT(progressive.unshot_share(), before);
    before = progressive.unshot_share();
    ASSERT_TRUE(progressive.step());
  }
  EXPECT_GT(progressive.energy().escaped, 0.0);
}

// All surfaces have equal emission and reflectance, so the prediction is exact: B = M / (1 - rho).
TEST(Progressive, TheAmbientTermOfAFurnaceIsRightFromTheBeginning) {
  constexpr float rho = 0.7f, M = 2.0f;
  const Solved room(test::furnace(rho, M, true));
  const ProgressiveRadiosity progressive(room.scene, room.mesh,
                                         cast_shots(room.caster, room.paths, 512));
  for (int k = 0; k < 3; ++k) {
    EXPECT_NEAR(M + rho * progressive.ambient()[k], M / (1.0f - rho), 1e-5f);
  }
}

TEST(Progressive, TheAmbientTermBringsFirstPicturesNearer) {
  const Solved room(lamp_room(0.8f, false));
  const auto F = room.form_factors();
  const BandArray wanted = solve_radiosity(SolverMethod::automatic, room.mesh, *F).patch_radiosity;
  ProgressiveRadiosity progressive(room.scene, room.mesh, stored_shots(*F));
  ASSERT_TRUE(progressive.step());
  const BandArray plain = progressive.radiosity();
  const BandArray with_ambient =
      plain + room.mesh.reflectance.rowwise() * progressive.ambient().transpose();
  EXPECT_LT(rms(room.mesh, with_ambient, wanted), 0.7 * rms(room.mesh, plain, wanted));
}

TEST(Progressive, OvershootingNeedsFewerShotsForTheSameAnswer) {
  const Solved room(lamp_room(0.8f, false));
  const auto F = room.form_factors();
  const BandArray wanted =
      solve_radiosity(SolverMethod::automatic, room.mesh, *F, {.tolerance = 1e-7}).patch_radiosity;
  const auto shots_to = [&](Overshooting overshooting, double error) {
    ProgressiveRadiosity progressive(room.scene, room.mesh, stored_shots(*F),
                                     {.tolerance = 1e-7, .overshooting = overshooting});
    while (rms(room.mesh, progressive.radiosity(), wanted) > error && progressive.step()) {
    }
    EXPECT_LE(rms(room.mesh, progressive.radiosity(), wanted), error);
    return progressive.shots();
  };
  constexpr double error = 0.01;
  EXPECT_LT(shots_to(Overshooting::ambient, error), shots_to(Overshooting::none, error));
  shots_to(Overshooting::ambient, 1e-5);
}

TEST(VertexLight, SeesShadowsAfterTheFirstRoundAndAllLightInTheEnd) {
  const Solved room(lamp_room(0.6f, false));
  const auto F = room.form_factors();
  ProgressiveRadiosity progressive(room.scene, room.mesh, stored_shots(*F));
  VertexLight light(room.caster, room.direct_light);
  const GatherOptions many_rays{.rays = 4096};
  const std::vector<GatherPoint> points = vertex_gather_points(room.mesh);
  // The lamp has few patches: all of them shoot in the first round.
  ASSERT_TRUE(progressive.step());
  light.receive(progressive.last_shots());
  const BandArray nothing = BandArray::Zero(room.mesh.vertex_count(), 3);
  const BandArray direct =
      gather_irradiance({room.scene, room.caster, room.direct_light}, nothing, points, many_rays)
          .direct;
  const auto relative = [](const BandArray& a, const BandArray& b) {
    return std::sqrt((a - b).square().cast<double>().sum() / b.square().cast<double>().sum());
  };
  EXPECT_LT(relative(light.irradiance(), direct), 0.01);
  while (progressive.step()) light.receive(progressive.last_shots());
  const BandArray B = gatherable_radiosity(room.mesh, room.direct_light, light.irradiance());
  const GatheredIrradiance all =
      gather_irradiance({room.scene, room.caster, room.direct_light}, B, points, many_rays);
  // One ray per shooter, and one value per shooter, in only 300 patches.
  EXPECT_LT(relative(light.irradiance(), all.direct + all.indirect), 0.03);
}

/// The same shots carry the light of all channels, each of which equals the channel's light alone.
TEST(Progressive, KeepsChannelsApart) {
  Scene scene = lamp_room(0.6f, true);
  const int second = add_material(scene, diffuse(scene.bands, 0.0f, 4.0f));
  add_box(scene, {1.5, 1.1, 0.9}, {1.7, 1.3, 1.0}, {second, second, second, second, second, second},
          false);
  const EmitterChannels channels = channels_per_luminaire(scene);
  const auto count = static_cast<Eigen::Index>(channels.names.size());
  ASSERT_EQ(count, 6) << "one for each name among the boxes' faces, of which two share one";
  const Solved room(scene);
  const auto F = room.form_factors();
  constexpr ProgressiveOptions options{.tolerance = 1e-6};
  ProgressiveRadiosity together(room.scene, room.mesh, stored_shots(*F), options);
  ProgressiveRadiosity apart(room.scene, room.mesh, stored_shots(*F), options, channels);
  run(together);
  run(apart);
  const RadiositySolution solution = apart.solution();
  // Both end with 1e-6 of the power unshot; the rest is float rounding of many small additions.
  EXPECT_LT(rms(room.mesh, solution.patch_radiosity, together.radiosity()), 1e-5);
  RadiositySolution wanted;
  wanted.patch_radiosity = solution.patch_radiosity;
  solve_channels(room.scene, room.mesh, *F, FreeLight{}, channels, SolverMethod::automatic,
                 {.tolerance = 1e-7}, wanted);
  EXPECT_EQ(solution.patch_channel, wanted.patch_channel);
  double emitted = 0.0;
  for (std::size_t c = 0; c < solution.channels.size(); ++c) {
    const LightChannel &found = solution.channels[c], &exact = wanted.channels[c];
    EXPECT_EQ(found.name, exact.name);
    EXPECT_EQ(found.surfaces, exact.surfaces);
    // Extended form factors are not reciprocal: see ToTheEndIsWhatGaussSeidelFinds.
    EXPECT_LT(rms(room.mesh, found.patch_radiosity, exact.patch_radiosity), 5e-3) << found.name;
    emitted += found.energy.row(0).sum();
  }
  EXPECT_NEAR(emitted, together.energy().emitted, 1e-6 * emitted);
}

TEST(Progressive, IsTheSameForAnyNumberOfThreads) {
  const Solved room(lamp_room(0.6f, true));
  BandArray first;
  for (const int threads : {1, 2, 5}) {
    const ThreadLimit limit(threads);
    ProgressiveRadiosity progressive(room.scene, room.mesh,
                                     cast_shots(room.caster, room.paths, 1024),
                                     {.max_shots = 200, .most_rays = 1024});
    run(progressive);
    EXPECT_EQ(progressive.shots(), 200);
    if (first.size() == 0) first = progressive.radiosity();
    EXPECT_TRUE((progressive.radiosity() == first).all()) << threads << " threads";
  }
}

TEST(Progressive, SolvesASceneAsTheEquationsDo) {
  for (const bool with_mirror : {false, true}) {
    const Scene scene = lamp_room(0.6f, with_mirror);
    // Uniform elements: refined elements would differ between the two solutions.
    SolveOptions options{.mesh = {.auto_patch_count = 300}, .refine = {.tolerance = 0.0}};
    const SolvedScene by_equations = solve_scene(scene, options);
    options.progressive = {.tolerance = 1e-5, .overshooting = Overshooting::ambient};
    const SolvedScene by_shots = solve_scene(scene, options);
    EXPECT_EQ(by_shots.solution.solver, "progressive");
    EXPECT_EQ(by_shots.solution.outcome, Outcome::converged);
    expect_balanced(by_shots.solution.energy, 1e-5);
    const BandArray a = by_shots.solution.irradiance(), b = by_equations.solution.irradiance();
    // Both gather anew from 300 patches with a noise of 1 to 2 % each; a gather averages over many.
    EXPECT_LT(std::sqrt((a - b).square().cast<double>().mean()) / b.cast<double>().mean(), 5e-3);
  }
}

/// Shooters one at a time are the brightest at that moment. In a scene without mirrors every shot
/// reduces the unshot power, by the shooter's power less the part that receivers reflect.
TEST(Progressive, ShootsOneByOneWhenAsked) {
  const Solved room(lamp_room(0.5f, false));
  ProgressiveRadiosity progressive(room.scene, room.mesh,
                                   cast_shots(room.caster, room.paths, 1 << 12));
  for (int shots = 1; shots <= 20; ++shots) {
    Eigen::ArrayXd power(room.mesh.patch_count());
    for (int i = 0; i < power.size(); ++i) {
      power[i] = room.mesh.area[i] * progressive.unshot().row(i).cast<double>().sum();
    }
    const double before = progressive.unshot_share();
    ASSERT_TRUE(progressive.step(1));
    EXPECT_EQ(progressive.shots(), shots);
    ASSERT_EQ(progressive.last_shots().size(), 1u);
    EXPECT_EQ(power[progressive.last_shots()[0].patch], power.maxCoeff());
    EXPECT_LT(progressive.unshot_share(), before);
  }
}

/// Shooting and gathering in separate calls equal solve_scene, bit for bit.
TEST(Progressive, GatheringCanBeHadForItself) {
  const Scene scene = lamp_room(0.5f, true);
  SolveOptions options;
  options.mesh.auto_patch_count = 300;
  options.progressive.emplace(ProgressiveOptions{.tolerance = 1e-2});
  options.gather.rays = 64;
  options.error_points = 16;
  const SolvedScene wanted = solve_scene(scene, options);

  SolvedScene patches;
  MeshOptions mesh_options = options.mesh;
  mesh_options.to_be_refined = starts_coarse(options);
  patches.mesh = build_patches(scene, mesh_options);
  {
    const ElementCaster caster(patches.mesh);
    const LightPaths paths(scene, caster, options.form_factors.max_specular_depth);
    ProgressiveRadiosity progressive(scene, patches.mesh,
                                     cast_shots(caster, paths, options.progressive->most_rays),
                                     *options.progressive);
    patches.solution = shoot_to_the_end(progressive);
  }
  const SolvedScene solved = gather_to_elements(scene, std::move(patches), options);
  ASSERT_EQ(solved.mesh.element_count(), wanted.mesh.element_count());
  EXPECT_TRUE((solved.solution.irradiance() == wanted.solution.irradiance()).all());
  EXPECT_EQ(solved.solution.error_estimate, wanted.solution.error_estimate);
  EXPECT_EQ(solved.solution.energy.absorbed, wanted.solution.energy.absorbed);
  EXPECT_EQ(solved.solution.provenance.scene_hash, scene_hash(scene));
}

TEST(Progressive, WithoutLightThereIsNothingToDo) {
  const Solved room(test::furnace(0.5f, 0.0f, false));
  ProgressiveRadiosity progressive(room.scene, room.mesh, cast_shots(room.caster, room.paths, 64));
  EXPECT_FALSE(progressive.step());
  EXPECT_TRUE((progressive.radiosity() == 0.0f).all());
}

}  // namespace
}  // namespace lightwell::progressive_test
