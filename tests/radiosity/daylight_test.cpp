// Sky and sun in the solve: closed forms, energy, channels.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <numbers>
#include <string_view>

#include "mesh/build_patches.h"
#include "radiosity/closed_forms/polygon_form_factor.h"
#include "radiosity/gather/final_gather.h"
#include "radiosity/gather/vertex_points.h"
#include "radiosity/solve.h"
#include "scene/parallel.h"
#include "tests/radiosity/test_scenes.h"

namespace lightwell::daylight_test {
namespace {

using Eigen::Vector3d;

constexpr double pi = std::numbers::pi;

// A room of 4 x 4 x 3 m whose wall x1 has a hole of 1.6 x 1.4 m.
Scene room(float rho) {
  Scene scene;
  const int wall = test::add_material(scene, test::diffuse(scene.bands, rho));
  test::add_box(scene, {0, 0, 0}, {4, 4, 3}, {wall, wall, wall, wall, wall, wall}, true);
  auto& mesh = std::get<PolygonMesh>(scene.surfaces[1].shape);
  const int first = static_cast<int>(mesh.vertices.size());
  for (const Vector3d& p : {Vector3d(4, 1.2, 0.9), Vector3d(4, 2.8, 0.9), Vector3d(4, 2.8, 2.3),
                            Vector3d(4, 1.2, 2.3)}) {
    mesh.vertices.push_back(p);
  }
  mesh.facets[0].holes = {{first, first + 1, first + 2, first + 3}};
  return scene;
}

// Elements of even size: the tests check light, not refinement.
SolveOptions quick() {
  return {.form_factors = {.rays_per_patch = 256},
          .gather = {.rays = 128, .shadows = {.min_rays = 16, .max_rays = 128}},
          .refine = {.tolerance = 0.0},
          .error_points = 128};
}

void expect_balance(const SolvedScene& solved) {
  const EnergyBalance& energy = solved.solution.energy;
  EXPECT_GT(energy.emitted, 0.0);
  // Radiosities are floats, each off by up to 6e-8 of either sign.
  EXPECT_NEAR(energy.absorbed + energy.escaped + energy.unshot, energy.emitted,
              2e-7 * energy.emitted);
}

// Walls of a dome of 3 km that emit what an even sky of radiance L would send, M = pi L, light a
// room through its window as the sky does, brighter near it: a floor of one patch would have its
// mean everywhere. The quarter of the floor that is farthest away has the noise of some 70 rows of
// 256 rays: of the order of 1 / sqrt(256 x 70) = 0.75 % for each of the scenes. The tolerance is
// three times the noise of both, 3.2 %.
TEST(Daylight, DomeOfKilometresStandsForTheSky) {
  const auto far_radiosity = [](const Scene& scene) {
    const SolvedScene solved = solve_scene(scene, quick());
    double sum = 0.0, area = 0.0;
    for (int e = 0; e < solved.mesh.element_count(); ++e) {
      const int p = solved.mesh.patch[e];
      if (solved.mesh.surface[p] != 4 || solved.mesh.is_back[p] != 0) continue;
      if (element_center(solved.mesh, e).position.x() > 1.0) continue;
      sum += solved.mesh.element_area[e] * solved.solution.patch_radiosity(p, 0);
      area += solved.mesh.element_area[e];
    }
    return sum / area;
  };
  Scene under_sky = room(0.6f), within_dome = room(0.6f);
  under_sky.sky = test::even_sky(under_sky.bands, 2.0f, 2.0f);
  Material light = test::diffuse(within_dome.bands, 0.0f);
  light.emission.setConstant(2.0f * static_cast<float>(pi));
  const int m = test::add_material(within_dome, light);
  test::add_box(within_dome, {-3000, -3000, -3000}, {3000, 3000, 3000}, {m, m, m, m, m, m}, true);
  const double expected = far_radiosity(under_sky);
  EXPECT_NEAR(far_radiosity(within_dome), expected, 3.0 * std::sqrt(2.0) * 0.0075 * expected);
}

// A body alone in light of the same radiance L from all around receives pi L: B = rho pi L.
TEST(Daylight, ConvexBodyUnderAnEvenSkyIsAFurnace) {
  Scene scene;
  const int m = test::add_material(scene, test::diffuse(scene.bands, 0.6f));
  test::add_box(scene, {0, 0, 0}, {1.0, 1.3, 0.8}, {m, m, m, m, m, m}, false);
  scene.sky = test::even_sky(scene.bands, 2.0f, 2.0f);
  const SolvedScene solved = solve_scene(scene, quick());
  const BandArray E = solved.solution.irradiance();
  // Every ray brings the same light, so there is no noise. The dome's directions are 512 around: a
  // midpoint rule with a step of 2 pi / 512 across a horizon is off by up to that squared, 1.5e-4.
  EXPECT_NEAR(E.minCoeff(), 2.0 * pi, 1.5e-4 * 2.0 * pi);
  EXPECT_NEAR(E.maxCoeff(), 2.0 * pi, 1.5e-4 * 2.0 * pi);
  EXPECT_NEAR(solved.solution.patch_radiosity.mean(), 0.6 * 2.0 * pi, 1.5e-4 * 0.6 * 2.0 * pi);
  expect_balance(solved);
  EXPECT_EQ(solved.solution.energy.missed, 0.0);
}

TEST(Daylight, RoomWithAWindowBalancesAndItsDirectLightIsTheClosedForm) {
  Scene scene = room(0.5f);
  scene.sky = test::even_sky(scene.bands, 100.0f, 100.0f);
  const SolvedScene solved = solve_scene(scene, quick());
  expect_balance(solved);
  const std::vector<Vector3d> window = {{4, 1.2, 0.9}, {4, 1.2, 2.3}, {4, 2.8, 2.3}, {4, 2.8, 0.9}};
  // The light that enters is pi L times the window's area.
  EXPECT_NEAR(solved.solution.energy.emitted, 3.0 * 100.0 * pi * 1.6 * 1.4,
              0.01 * 3.0 * 100.0 * pi * 1.6 * 1.4);
  double squares = 0.0, of_truth = 0.0;
  const auto points = vertex_gather_points(solved.mesh);
  for (std::size_t v = 0; v < points.size(); ++v) {
    const double truth =
        100.0 * pi * std::abs(point_to_polygon(points[v].position, points[v].normal, window));
    const double found =
        static_cast<double>(solved.solution.direct_irradiance(static_cast<Eigen::Index>(v), 0));
    squares += (found - truth) * (found - truth);
    of_truth += truth * truth;
  }
  // A share p of the 16 + 128 rays finds the window, an eighth to a half by its distance. Each
  // vertex is off by sqrt((1 - p) / (144 p)), 0.22 to 0.08. Near and bright vertices, with a large
  // p, weigh most: sqrt(0.7 / (144 * 0.3)) = 0.127. A bias would show in the light that enters,
  // above.
  EXPECT_LT(std::sqrt(squares / of_truth), 0.127);
}

TEST(Daylight, ShootingAndSolvingAgree) {
  Scene scene = room(0.5f);
  scene.sky = test::even_sky(scene.bands, 100.0f, 20.0f);
  const SolvedScene solved = solve_scene(scene, quick());
  SolveOptions shooting = quick();
  shooting.progressive = ProgressiveOptions{.tolerance = 1e-3};
  const SolvedScene shot = solve_scene(scene, shooting);
  const double one = solved.solution.irradiance().cast<double>().mean();
  // At most a thousandth of the light is left unshot.
  EXPECT_NEAR(shot.solution.irradiance().cast<double>().mean(), one, 1e-3 * one);
}

// A horizontal sun draws the window as a bright patch on the far wall.
TEST(Daylight, SunDrawsTheWindowOnTheWall) {
  Scene scene = room(0.0f);
  scene.sky = test::even_sky(scene.bands, 0.0f, 0.0f);
  scene.sky->sun =
      Sun{.direction = Vector3d::UnitX(), .irradiance = constant_spectrum(scene.bands, 500.0f)};
  const PatchMesh mesh = build_patches(scene, {});
  const ElementCaster caster(mesh);
  const DirectLight light(scene, mesh);
  const auto at = [&](double y, double z) {
    return static_cast<double>(
        light.irradiance(caster, {.at = {{0, y, z}, Vector3d::UnitX(), 0}, .key = 1})[0]);
  };
  constexpr double rounding = 500.0 * 1.2e-7;  // of a float
  EXPECT_NEAR(at(2.0, 1.5), 500.0, rounding);
  EXPECT_NEAR(at(1.3, 2.2), 500.0, rounding);
  EXPECT_EQ(at(1.0, 1.5), 0.0);
  EXPECT_EQ(at(2.0, 2.6), 0.0);
  // On the edge half of the disc is seen, by stratified rays to within about one ray. The penumbra
  // is 4 m tan 0.533 degrees = 37 mm wide; 10 mm further in, 0.83 of the disc is seen.
  EXPECT_NEAR(at(1.2, 1.5), 250.0, 500.0 / 16.0);
  EXPECT_GT(at(1.21, 1.5), 290.0);
  EXPECT_EQ(at(1.17, 1.5), 0.0);
}

// Beside an endless mirror the hidden half of the sky is seen in the mirror.
TEST(Daylight, MirrorGivesBackItsHalfOfTheSky) {
  Scene scene;
  const int ground = test::add_material(scene, test::diffuse(scene.bands, 0.5f));
  const int silver = test::add_material(scene, test::mirror(scene.bands, 0.8f));
  constexpr double far = 400.0;
  test::add_polygon(scene, "ground", ground, {{0, -1, 0}, {2, -1, 0}, {2, 1, 0}, {0, 1, 0}});
  test::add_polygon(scene, "mirror", silver,
                    {{0, -far, 0}, {0, far, 0}, {0, far, far}, {0, -far, far}});
  scene.sky = test::even_sky(scene.bands, 1.0f, 0.0f);
  const PatchMesh mesh = build_patches(scene, {});
  const ElementCaster caster(mesh);
  const DirectLight light(scene, mesh);
  constexpr int count = 64;
  std::vector<GatherPoint> points;
  for (int i = 0; i < count; ++i) {
    points.push_back({.position = {1, (2.0 * i + 1.0) / count - 1.0, 0}, .facet = 0});
  }
  const BandArray none = BandArray::Zero(mesh.vertex_count(), 3);
  const GatheredIrradiance E =
      gather_irradiance({scene, caster, light}, none, points, {.rays = 4096});
  // Direct light: the mirror ends at `far`, so from 1 m its half of the sky lacks at most 1 / far
  // of its light. Cells beside the edge of the half, at most a tenth, are known from 160 rays to
  // sqrt(0.1 * 0.9 / 160) = 0.024 of the light without strata, and the mean of 64 points to 0.003,
  // about 1 / far; strata leave a third of that. Both errors come to 2 / far of the half, pi / far.
  // Indirect light: half of 4096 stratified rays meet the mirror, to within some sqrt(4096) rays on
  // its edge: 1 / 64 of the whole at worst.
  EXPECT_NEAR(E.direct.col(0).mean(), 0.5 * pi, pi / far);
  EXPECT_NEAR(E.indirect.col(0).mean(), 0.8 * 0.5 * pi, pi / far);
}

TEST(Daylight, SkyAndSunAreChannelsThatAddUp) {
  Scene scene = room(0.5f);
  scene.sky = test::even_sky(scene.bands, 100.0f, 20.0f);
  scene.sky->sun = Sun{.direction = Vector3d(1, 0.1, 0.5).normalized(),
                       .irradiance = constant_spectrum(scene.bands, 2000.0f)};
  SolveOptions options = quick();
  options.channels = channels_per_luminaire(scene);
  EXPECT_EQ(options.channels.names, (std::vector<std::string>{"sky", "sun"}));
  const SolvedScene solved = solve_scene(scene, options);
  const SolvedScene together = solve_scene(scene, quick());
  ASSERT_EQ(solved.solution.channels.size(), 2u);
  const double sum = solved.solution.irradiance().cast<double>().mean();
  // The same rays bring the same light, added up in another order of floats and solved to 1e-6.
  EXPECT_NEAR(sum, together.solution.irradiance().cast<double>().mean(), 2e-6 * sum);
  for (const LightChannel& channel : solved.solution.channels) {
    EXPECT_GT(channel.direct_irradiance.mean(), 0.0f) << channel.name;
  }
}

TEST(Daylight, SameBitsOnAnyNumberOfThreads) {
  Scene scene = room(0.5f);
  scene.sky = test::even_sky(scene.bands, 100.0f, 20.0f);
  scene.sky->sun = Sun{.direction = Vector3d(1, 0.1, 0.5).normalized(),
                       .irradiance = constant_spectrum(scene.bands, 2000.0f)};
  const auto found = [&](int threads) {
    const ThreadLimit limit(threads);
    return solve_scene(scene, quick()).solution.irradiance();
  };
  EXPECT_TRUE((found(1) == found(3)).all());
}

// Light that a tinted pane without reflection lets in is the tint's share of what the bare opening
// lets in, by whatever method the light is then followed.
class SunBehindAPane : public testing::Test {
 protected:
  static Scene behind(bool pane) {
    Scene scene = room(0.5f);
    if (pane) {
      Material material = test::clear_glass(scene.bands);
      material.dielectric->index_of_refraction = 1.0f;
      material.dielectric->tint << 0.8f, 0.5f, 0.25f;
      material.dielectric->thin = true;
      test::add_polygon(scene, "pane", test::add_material(scene, material),
                        {{4.1, 1, 0.7}, {4.1, 3, 0.7}, {4.1, 3, 2.5}, {4.1, 1, 2.5}});
    }
    scene.sky = test::even_sky(scene.bands, 0.0f, 0.0f);
    scene.sky->sun = Sun{.direction = Vector3d(1, 0.1, 0.7).normalized(),
                         .irradiance = constant_spectrum(scene.bands, 2000.0f)};
    return scene;
  }

  static void expect_tinted(const SolveOptions& options, std::string_view method) {
    const SolvedScene bare = solve_scene(behind(false), options);
    const SolvedScene tinted = solve_scene(behind(true), options);
    const int count = bare.mesh.patch_count();
    const std::array<double, 3> tint = {0.8, 0.5, 0.25};
    for (int k = 0; k < 3; ++k) {
      double with = 0.0, without = 0.0;
      for (int i = 0; i < count; ++i) {
        with += bare.mesh.area[i] * static_cast<double>(tinted.solution.patch_radiosity(i, k));
        without += bare.mesh.area[i] * static_cast<double>(bare.solution.patch_radiosity(i, k));
      }
      // The direct light has the same rays. Reflected light is as much again (reflectance 0.5). A
      // patch sends 256 rays, of which a hundredth end in the opening or miss it: 0.01 / sqrt(256)
      // of its light, with either sign for each of 100 patches and more.
      EXPECT_NEAR(with / without, tint[k], 1e-3 * tint[k]) << method;
    }
  }
};

TEST_F(SunBehindAPane, IsTintedByEveryFormFactorMethod) {
  for (const NamedFormFactorMethod& method : form_factor_methods) {
    SolveOptions options = quick();
    options.mesh.max_patch_size = 1.0;
    options.form_factors.method = method.method;
    // Rays count the light that escapes through the bare opening.
    options.form_factors.rays_per_patch = 4096;
    expect_tinted(options, method.name);
  }
}

TEST_F(SunBehindAPane, IsTintedByEverySolver) {
  for (const NamedSolverMethod& method : solver_methods) {
    SolveOptions options = quick();
    options.mesh.max_patch_size = 1.0;
    options.solver_method = method.method;
    expect_tinted(options, method.name);
  }
  SolveOptions options = quick();
  options.mesh.max_patch_size = 1.0;
  options.progressive = ProgressiveOptions{.tolerance = 1e-4};
  expect_tinted(options, "progressive");
}

TEST(Daylight, SceneWithoutLightIsStillRefused) {
  Scene scene = room(0.5f);
  scene.sky = test::even_sky(scene.bands, 0.0f, 0.0f);
  EXPECT_ANY_THROW(solve_scene(scene, quick()));
}

}  // namespace
}  // namespace lightwell::daylight_test
