// Light that passes thin sheets diffusely, B = M + rho E + tau E_behind, or straight on.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <vector>

#include "mesh/patches/translucency.h"
#include "radiosity/closed_forms/polygon_form_factor.h"
#include "radiosity/paths/light_path.h"
#include "radiosity/solution/solution_file.h"
#include "radiosity/solve.h"
#include "radiosity/solvers/progressive.h"
#include "radiosity/solvers/solve_radiosity.h"
#include "scene/errors.h"
#include "tests/radiosity/given_form_factors.h"
#include "tests/radiosity/named_methods.h"
#include "tests/radiosity/test_scenes.h"
#include "tests/temporary_folder.h"

namespace lightwell::translucency_test {
namespace {

using test::add_material;
using test::add_polygon;
using test::diffuse;

std::array<int, 6> of_six(int material) {
  return {material, material, material, material, material, material};
}

Material sheet(const Bands& bands, float rho, float tau, float straight = 0.0f) {
  Material material = diffuse(bands, rho);
  material.one_sided = false;
  material.transmittance = constant_spectrum(bands, tau);
  if (straight > 0.0f) material.regular_transmittance = constant_spectrum(bands, straight);
  return material;
}

// A bright ball of radius 1/4 within a translucent shell of radius 1 within a ball of radius 2:
// four patches, of which the shell's sides are numbers 1 and 2. Form factors between concentric
// spheres are ratios of areas.
struct Lampshade {
  static constexpr double ball = 0.25 * 0.25, shell = 1.0, room = 4.0;
  static constexpr float rho = 0.35f, tau = 0.45f, walls = 0.6f, exitance = 8.0f;

  static PatchMesh mesh() {
    PatchMesh mesh = test::patches(Eigen::Array4d(ball, shell, shell, room),
                                   Eigen::Array4f(0.0f, rho, rho, walls),
                                   Eigen::Array4f(exitance, 0.0f, 0.0f, 0.0f));
    mesh.material = {0, 1, 1, 2};
    mesh.transmittance = Eigen::Array4f(0.0f, tau, tau, 0.0f).replicate(1, 3);
    mesh.behind = {-1, 2, 1, -1};
    return mesh;
  }
  static test::GivenFormFactors form_factors() {
    Eigen::ArrayXXd F = Eigen::ArrayXXd::Zero(4, 4);
    F(0, 1) = 1.0;
    F(1, 0) = ball / shell;
    F(1, 1) = 1.0 - ball / shell;
    F(2, 3) = 1.0;
    F(3, 2) = shell / room;
    F(3, 3) = 1.0 - shell / room;
    return test::GivenFormFactors(F);
  }
  static Scene scene() {
    Scene scene;
    scene.materials = {diffuse(scene.bands, 0.0f, exitance), sheet(scene.bands, rho, tau),
                       diffuse(scene.bands, walls)};
    return scene;
  }
  // The closed form. With f the share of the shell that the ball fills, E within is
  //   E_i = f M + (1 - f) B_i,  B_i = rho E_i + tau E_o,  B_o = rho E_o + tau E_i,
  // and E_o = w E_w is that of the room's wall, E_w = g B_o + (1 - g) w E_w.
  static Eigen::Array4d exact() {
    const double f = ball / shell, g = shell / room, M = double{exitance}, w = double{walls};
    const double r = double{rho}, t = double{tau};
    const double back = w * g / (1.0 - (1.0 - g) * w);  // E_o / B_o
    // B_o = r back B_o + t E_i, and E_i (1 - (1 - f) r) = f M + (1 - f) t back B_o.
    const double out = t / (1.0 - r * back);  // B_o / E_i
    const double E_i = f * M / (1.0 - (1.0 - f) * (r + t * back * out));
    const double B_o = out * E_i, E_o = back * B_o;
    return {M, r * E_i + t * E_o, B_o, w * E_o / w};
  }
};

class EachSolver : public testing::TestWithParam<NamedSolverMethod> {};

// Form factors and B are floats, each off by 6e-8 of itself. Up to 1 / (1 - 0.8) = 5 reflections
// add up the errors of form factors to 3e-7. The solvers leave 1e-8 of the largest B, 8, which is
// 7e-7 of the dimmest, 0.11. Both together are 1e-6.
TEST_P(EachSolver, LightsALampshadeAsItsClosedForm) {
  const PatchMesh mesh = Lampshade::mesh();
  const auto solve = [&] {
    return solve_radiosity(GetParam().method, mesh, Lampshade::form_factors(),
                           {.tolerance = 1e-8, .max_sweeps = 1000});
  };
  if (GetParam().method == SolverMethod::conjugate_gradients) {
    EXPECT_THROW(solve(), InputError);
    return;
  }
  const RadiositySolution solved = solve();
  const Eigen::Array4d exact = Lampshade::exact();
  for (int i = 0; i < 4; ++i) {
    EXPECT_NEAR(double{solved.patch_radiosity(i, 0)} / exact[i], 1.0, 1e-6) << i;
  }
}

INSTANTIATE_TEST_SUITE_P(Solvers, EachSolver, testing::ValuesIn(solver_methods),
                         test::name_of_solver);

// Progressive refinement leaves the share 1e-7 of the emitted 0.5 W unshot. 5 reflections
// make 2.5e-7 W of that, or 8e-7 of the B of the shell's inside, 0.33. B is the sum of some ten
// floats besides, 6e-7. Energy adds shares as floats, each off by 6e-8, over some ten reflections.
TEST(Progressive, LightsALampshadeAsItsClosedForm) {
  const Scene scene = Lampshade::scene();
  const PatchMesh mesh = Lampshade::mesh();
  const test::GivenFormFactors F = Lampshade::form_factors();
  ProgressiveOptions options;
  options.tolerance = 1e-7;
  ProgressiveRadiosity progressive(scene, mesh, stored_shots(F), options);
  const RadiositySolution solved = shoot_to_the_end(progressive);
  const Eigen::Array4d exact = Lampshade::exact();
  for (int i = 0; i < 4; ++i) {
    EXPECT_NEAR(double{solved.patch_radiosity(i, 0)} / exact[i], 1.0, 2e-6) << i;
  }
  const EnergyBalance energy = solved.energy;
  EXPECT_NEAR((energy.absorbed + energy.unshot) / energy.emitted, 1.0, 1e-6);
}

// A closed room of B = 2 everywhere, with a sheet across that reflects and passes all light, or
// half of it and shines besides.
class SheetInAFurnace : public testing::TestWithParam<std::array<float, 2>> {};

TEST_P(SheetInAFurnace, IsInvisible) {
  const auto [rho, tau] = GetParam();
  Scene scene = test::furnace(0.5f, 1.0f, false);
  Material material = sheet(scene.bands, rho, tau);
  material.emission = constant_spectrum(scene.bands, 2.0f * (1.0f - rho - tau));
  material.emits_both_sides = true;
  add_polygon(scene, "sheet", add_material(scene, material),
              {{0.1, 0.2, 0.4}, {0.9, 0.2, 0.5}, {0.9, 1.0, 0.5}, {0.1, 1.0, 0.4}});
  SolveOptions options;
  options.mesh.max_patch_size = 0.2;
  options.form_factors.rays_per_patch = 128;
  options.gather.rays = 64;
  const SolvedScene solved = solve_scene(scene, options);
  const BandArray B = vertex_radiosity(solved.mesh, solved.solution);
  const double patch_error =
      (solved.solution.patch_radiosity.cast<double>() / 2.0 - 1.0).abs().maxCoeff();
  const double vertex_error = (B.cast<double>() / 2.0 - 1.0).abs().maxCoeff();
  std::printf("sheet rho %.2f tau %.2f: worst relative error %.1e (patches), %.1e (vertices)\n",
              double{rho}, double{tau}, patch_error, vertex_error);
  // Rows of some hundred floats add up to 1 within 1e-6, and few reflections follow. Vertices
  // gather 64 rays, whose weights add up to 4e-6 of rounding.
  EXPECT_LT(patch_error, 1e-5);
  EXPECT_LT(vertex_error, 1e-5);
  EXPECT_NEAR(solved.solution.energy.absorbed / solved.solution.energy.emitted, 1.0, 1e-5);
}

INSTANTIATE_TEST_SUITE_P(Sheets, SheetInAFurnace,
                         testing::Values(std::array{0.4f, 0.6f}, std::array{0.0f, 1.0f},
                                         std::array{0.3f, 0.2f}, std::array{0.05f, 0.9f}));

// Two black rooms of 1 m parted by a sheet. One is so lit that the sheet has E = 1 everywhere on
// that side; the other gets B = tau from it.
Scene two_rooms(float tau) {
  Scene scene;
  const int lit = add_material(scene, diffuse(scene.bands, 0.0f, 1.0f)),
            black = add_material(scene, diffuse(scene.bands, 0.0f));
  Material material = sheet(scene.bands, 0.3f, tau);
  const int parting = add_material(scene, material);
  test::add_box(scene, {-1, 0, 0}, {0, 1, 1}, of_six(lit), true);
  test::add_box(scene, {0, 0, 0}, {1, 1, 1}, of_six(black), true);
  // The walls of both boxes at x = 0 make way for the sheet.
  scene.surfaces.erase(scene.surfaces.begin() + 6);
  scene.surfaces[1].material = parting;
  return scene;
}

// Behind a perfect diffuser: B of the sheet is tau, and the wall opposite gets tau times the form
// factor of two unit squares a unit apart (Howell's catalogue, C-11), 0.1998249. Closed forms have
// an error of 1e-6; floats round some ten times.
TEST(RoomBehindADiffuser, GetsItsClosedForm) {
  const float tau = 0.6f;
  const Scene scene = two_rooms(tau);
  const PatchMesh mesh = build_patches(scene, {.max_patch_size = 2.0});
  const ElementCaster caster(mesh);
  const DirectLight direct_light(scene, mesh);
  const auto F =
      compute_form_factors({scene, caster, direct_light}, {.method = FormFactorMethod::analytic});
  const RadiositySolution solved = solve_radiosity(SolverMethod::automatic, mesh, *F, {});
  const BandArray E = gather(*F, solved.patch_radiosity);
  int seen = 0;
  for (int p = 0; p < mesh.patch_count(); ++p) {
    if (mesh.behind[p] >= 0 && mesh.is_back[p] != 0) {
      EXPECT_NEAR(double{solved.patch_radiosity(p, 0)}, double{tau}, 1e-5);
      ++seen;
    }
    const PatchPoint middle = element_center(mesh, mesh.first_element[p]);
    if (middle.position.x() > 1.0 - 1e-9) {
      const double exact = double{tau} * 0.19982490;
      std::printf("behind a diffuser: E %.7f, exact %.7f\n", double{E(p, 0)}, exact);
      EXPECT_NEAR(double{E(p, 0)} / exact, 1.0, 1e-5);
      ++seen;
    }
  }
  EXPECT_EQ(seen, 2);
}

// The same by a whole solve: irradiance at vertices. Of N = 4096 rays of a vertex the share F hits
// the sheet; independent rays would have a standard error of sqrt((1 - F) / (F N)) of that, 4 % at
// the corners with F = 0.12, and stratified ones have less. Three times that is allowed for each
// vertex, and 1 % for the mean of 25 and more, whose standard error is a fifth of 4 %.
TEST(RoomBehindADiffuser, IsLitAtVertices) {
  const float tau = 0.6f;
  const Scene scene = two_rooms(tau);
  SolveOptions options;
  options.mesh.max_patch_size = 0.25;
  options.gather.rays = 4096;
  options.refine.tolerance = 0.0;
  const SolvedScene solved = solve_scene(scene, options);
  const PatchMesh& mesh = solved.mesh;
  const BandArray E = solved.solution.irradiance();
  const std::vector<Eigen::Vector3d> square = {{0, 0, 0}, {0, 1, 0}, {0, 1, 1}, {0, 0, 1}};
  int seen = 0;
  double mean = 0.0;
  for (int v = 0; v < mesh.vertex_count(); ++v) {
    if (mesh.position(v).x() < 1.0 - 1e-9 || mesh.vertex_normal[v].x() > -0.9) continue;
    const double F = point_to_polygon(mesh.position(v), -Eigen::Vector3d::UnitX(), square);
    const double ratio = double{E(v, 0)} / (double{tau} * F);
    EXPECT_NEAR(ratio, 1.0, 3.0 * std::sqrt((1.0 - F) / (F * options.gather.rays)));
    mean += ratio;
    ++seen;
  }
  ASSERT_GE(seen, 25);
  std::printf("behind a diffuser: E of %d vertices is off by %.2e in the mean\n", seen,
              mean / seen - 1.0);
  EXPECT_NEAR(mean / seen, 1.0, 0.01);
}

Scene room_with_curtain(float tau, float straight) {
  Scene scene;
  const int white = add_material(scene, diffuse(scene.bands, 0.7f)),
            lamp = add_material(scene, diffuse(scene.bands, 0.1f, 20.0f));
  test::add_box(scene, {0, 0, 0}, {2, 3, 2.5}, of_six(white), true);
  add_polygon(scene, "lamp", lamp,
              {{0.8, 0.5, 2.4}, {0.8, 0.8, 2.4}, {1.2, 0.8, 2.4}, {1.2, 0.5, 2.4}});
  const int curtain = add_material(scene, sheet(scene.bands, 0.3f, tau, straight));
  add_polygon(scene, "curtain", curtain,
              {{0.1, 1.5, 0.2}, {1.9, 1.5, 0.2}, {1.9, 1.5, 2.3}, {0.1, 1.5, 2.3}});
  return scene;
}

// Rows add up to 1 as floats. What passes straight on is that of the rays that met the curtain,
// where the curtain's own share has a closed form: with F near 0.1 and 128 rays, the row's count is
// off by sqrt(F (1 - F) / 128) = 0.027, of which the share 0.2 passes. Over some thousand rows and
// three bounces 0.2 * 0.027 / sqrt(1000) * sqrt(3) = 3e-4 is left; three times that is allowed.
TEST(Curtain, ConservesEnergy) {
  for (const float straight : {0.0f, 0.2f}) {
    SolveOptions options;
    options.mesh.max_patch_size = 0.3;
    options.form_factors.rays_per_patch = 128;
    options.gather.rays = 64;
    options.error_points = 64;
    const SolvedScene solved = solve_scene(room_with_curtain(0.4f, straight), options);
    const EnergyBalance& energy = solved.solution.energy;
    std::printf("curtain, straight %.1f: kept %.7f of what is emitted\n", double{straight},
                (energy.absorbed + energy.escaped) / energy.emitted);
    EXPECT_NEAR((energy.absorbed + energy.escaped + energy.unshot) / energy.emitted, 1.0,
                straight > 0.0f ? 9e-4 : 1e-5);
  }
}

// Lamps without a surface: a point lamp through a sheet that passes a share straight on gives the
// floor that share of what it gives without the sheet, whatever the share that is diffused.
TEST(Curtain, PassesItsShareOfLampsStraightOn) {
  Scene scene;
  add_polygon(scene, "floor", add_material(scene, diffuse(scene.bands, 0.0f)),
              {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}});
  add_polygon(scene, "sheet", add_material(scene, sheet(scene.bands, 0.0f, 0.0f, 0.3f)),
              {{-3, -3, 1}, {3, -3, 1}, {3, 3, 1}, {-3, 3, 1}});
  const Eigen::Vector3d at(0.3, 0.2, 2.0);
  scene.lamps = {{.name = "lamp", .position = at, .intensity = Spectrum::Constant(3, 5.0f)}};
  const PatchMesh mesh = build_patches(scene, {.max_patch_size = 0.5});
  const ElementCaster caster(mesh);
  const DirectLight direct_light(scene, mesh);
  const Eigen::Vector3d point(0.1, -0.4, 0.0);
  const Eigen::Vector3d to = at - point;
  const Spectrum E =
      direct_light.irradiance(caster, {.at = {point, Eigen::Vector3d::UnitZ(), 0}, .key = 1});
  // Products of floats.
  EXPECT_NEAR(double{E[0]} / (0.3 * 5.0 * to.z() / std::pow(to.norm(), 3)), 1.0, 1e-6);
}

// Numbers that a file holds come back, and the sides of sheets are found again.
TEST(TranslucentMesh, IsWrittenAndRead) {
  const TemporaryFolder folder;
  SolveOptions options;
  options.mesh.max_patch_size = 0.5;
  options.form_factors.rays_per_patch = 64;
  options.gather.rays = 64;
  const SolvedScene solved = solve_scene(room_with_curtain(0.4f, 0.1f), options);
  const auto file = folder.path() / "curtain.vtp";
  write_solution(file, solved);
  const SolvedScene read = read_solution(file);
  EXPECT_TRUE((read.mesh.transmittance == solved.mesh.transmittance).all());
  EXPECT_EQ(read.mesh.behind, solved.mesh.behind);
  EXPECT_TRUE(
      (vertex_radiosity(read.mesh, read.solution) == vertex_radiosity(solved.mesh, solved.solution))
          .all());
}

// Vertices on both sides of a sheet lie at the same places, also where elements were split.
TEST(TranslucentMesh, KnowsTheVerticesBehind) {
  SolveOptions options;
  options.mesh.max_patch_size = 0.5;
  options.form_factors.rays_per_patch = 64;
  options.gather.rays = 64;
  const SolvedScene solved = solve_scene(room_with_curtain(0.4f, 0.0f), options);
  const std::vector<int> behind = vertices_behind(solved.mesh);
  ASSERT_EQ(static_cast<int>(behind.size()), solved.mesh.vertex_count());
  int known = 0;
  for (int v = 0; v < solved.mesh.vertex_count(); ++v) {
    if (behind[v] < 0) continue;
    ++known;
    EXPECT_LT((solved.mesh.position(v) - solved.mesh.position(behind[v])).norm(), 1e-12);
    EXPECT_LT(solved.mesh.vertex_normal[v].dot(solved.mesh.vertex_normal[behind[v]]), -0.999);
  }
  EXPECT_GT(known, 0);
}

}  // namespace
}  // namespace lightwell::translucency_test
