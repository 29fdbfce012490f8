// Light between surfaces that show pictures or have holes.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "mesh/build_patches.h"
#include "radiosity/closed_forms/polygon_form_factor.h"
#include "radiosity/form_factors/form_factors.h"
#include "radiosity/gather/final_gather.h"
#include "radiosity/solve.h"
#include "scene/parallel.h"
#include "tests/pictures.h"
#include "tests/radiosity/test_scenes.h"

namespace lightwell::textures_test {
namespace {

// A closed room with a lamp below the ceiling; surface 4 is its floor.
Scene room(float floor) {
  Scene scene;
  const int white = test::add_material(scene, test::diffuse(scene.bands, 0.6f));
  const int below = test::add_material(scene, test::diffuse(scene.bands, floor));
  Material shining = test::diffuse(scene.bands, 0.0f, 20.0f);
  shining.one_sided = false;
  const int lamp = test::add_material(scene, shining);
  test::add_box(scene, {0, 0, 0}, {2, 2, 2}, {white, white, white, white, below, white}, true);
  test::add_polygon(scene, "lamp", lamp,
                    {{0.8, 0.8, 1.9}, {0.8, 1.2, 1.9}, {1.2, 1.2, 1.9}, {1.2, 0.8, 1.9}});
  return scene;
}

SolveOptions quick(double patch = 0.25) {
  SolveOptions options;
  options.mesh.max_patch_size = patch;
  options.form_factors.rays_per_patch = 512;
  options.gather.rays = 256;
  options.error_points = 64;
  return options;
}

// A floor whose picture is dark on one half equals two plain floors of those reflectances: patches
// and rays are the same, and rho differs by the rounding of texels.
TEST(Textures, ACheckeredFloorIsTwoPlainFloors) {
  constexpr float dark = 0.1f, bright = 0.8f;
  Scene pictured = room(0.5f);
  put_picture(pictured, 4, picture_of(2, 1, {dark, bright}));
  Scene plain = room(0.5f);
  plain.surfaces.erase(plain.surfaces.begin() + 4);
  const int one = test::add_material(plain, test::diffuse(plain.bands, dark));
  const int other = test::add_material(plain, test::diffuse(plain.bands, bright));
  test::add_polygon(plain, "dark", one, {{0, 0, 0}, {1, 0, 0}, {1, 2, 0}, {0, 2, 0}});
  test::add_polygon(plain, "bright", other, {{1, 0, 0}, {2, 0, 0}, {2, 2, 0}, {1, 2, 0}});
  const SolvedScene a = solve_scene(pictured, quick()), b = solve_scene(plain, quick());
  // Irradiance of the lower halves of the walls x = 0 and x = 2. By symmetry the lamp gives both
  // the same, so they differ by the light from the floor's halves.
  const auto wall_light = [](const SolvedScene& s) {
    Eigen::Array2d power = Eigen::Array2d::Zero(), area = Eigen::Array2d::Zero();
    for (int p = 0; p < s.mesh.patch_count(); ++p) {
      const int wall = s.mesh.surface[p];
      if (wall > 1 || element_center(s.mesh, s.mesh.first_element[p]).position.z() > 1.0) continue;
      power[wall] += s.mesh.area[p] * s.solution.patch_radiosity(p, 1) / s.mesh.reflectance(p, 1);
      area[wall] += s.mesh.area[p];
    }
    return Eigen::Array2d(power / area);
  };
  const Eigen::Array2d E = wall_light(a), wanted = wall_light(b);
  const double from_floor = E[1] - E[0], wanted_from_floor = wanted[1] - wanted[0];
  std::printf("light of the walls: %.4f %.4f, of plain floors %.4f %.4f\n", E[0], E[1], wanted[0],
              wanted[1]);
  EXPECT_GT(wanted_from_floor, 0.05 * wanted[0]) << "the bright half must matter to its wall";
  // 32 patches of a wall with 512 rays each: three standard deviations of counts are 2 %, of E
  // less, since only the light that does not come straight from lamps depends on them.
  EXPECT_LT((E / wanted - 1.0).abs().maxCoeff(), 0.01);
  EXPECT_NEAR(from_floor / wanted_from_floor, 1.0, 0.1);
  EXPECT_NEAR(a.solution.energy.emitted, b.solution.energy.emitted, 1e-4);
  EXPECT_NEAR(a.solution.energy.absorbed / b.solution.energy.absorbed, 1.0, 1e-4);
}

// Every wall emits M; one wall shows a picture of mean rho, finer than its patches, and the others
// reflect rho. So B = M / (1 - rho) if the picture's mean over each patch is rho.
TEST(Textures, AFurnaceWithATexturedWallCloses) {
  constexpr float rho = 0.5f, M = 2.0f;
  Scene scene = test::furnace(rho, M, false);
  std::vector<float> squares;
  for (int i = 0; i < 64 * 64; ++i) squares.push_back((i + i / 64) % 2 == 0 ? 0.2f : 0.8f);
  put_picture(scene, 4, picture_of(64, 64, squares));
  const SolvedScene solved = solve_scene(scene, quick(0.2));
  const double B = M / (1.0 - rho);
  // The mean over a patch of 12 to 16 squares along, by 16 x 16 points on each of its elements.
  const double off = (solved.mesh.reflectance - rho).abs().maxCoeff();
  EXPECT_LT(off, 0.02);
  // A patch's own B follows its own rho, and the B of others the mean rho.
  EXPECT_LT((solved.solution.patch_radiosity / B - 1.0).abs().maxCoeff(), 1e-4 + 2.0 * off);
  const EnergyBalance e = solved.solution.energy;
  EXPECT_NEAR((e.absorbed + e.escaped) / e.emitted, 1.0, 1e-4);
}

// A room with a screen across the middle, bright on both sides; `columns` is the mask of the
// screen, 0 for holes.
Scene parted_room(const std::vector<float>& columns) {
  Scene scene = test::furnace(0.5f, 1.0f, false);
  Material screen = test::diffuse(scene.bands, 0.5f);
  screen.one_sided = false;
  test::add_polygon(scene, "screen", test::add_material(scene, screen),
                    {{0.5, 0, 0}, {0.5, 1.2, 0}, {0.5, 1.2, 0.9}, {0.5, 0, 0.9}});
  put_mask(scene, 6, picture_of(static_cast<int>(columns.size()), 1, columns));
  return scene;
}

double covered_area(const PatchMesh& mesh, int surface) {
  double area = 0.0;
  for (int p = 0; p < mesh.patch_count(); ++p) {
    if (mesh.surface[p] == surface && !mesh.is_back[p]) area += mesh.area[p];
  }
  return area;
}

// Walls emit M and reflect rho, and the screen reflects rho alone. A screen that is one hole has no
// effect: B = M / (1 - rho). With any mask, all emitted light is absorbed.
TEST(Textures, HolesLetLightThroughAndEnergyBalances) {
  SolveOptions options = quick(0.2);
  for (const auto method : {FormFactorMethod::automatic, FormFactorMethod::ray_cast,
                            FormFactorMethod::analytic, FormFactorMethod::hemicube}) {
    options.form_factors.method = method;
    options.form_factors.hemicube_resolution = 64;
    const SolvedScene open = solve_scene(parted_room({0, 0, 0, 0}), options);
    const BandArray& B = open.solution.patch_radiosity;
    for (int p = 0; p < open.mesh.patch_count(); ++p) {
      if (open.mesh.surface[p] == 6) continue;
      EXPECT_NEAR(B(p, 0), 2.0, 0.002 * 2.0) << "a thousandth of the screen is left";
    }
    const Scene scene = parted_room({1, 0, 1, 0});
    const SolvedScene half = solve_scene(scene, options);
    EXPECT_NEAR(covered_area(half.mesh, 6), 0.5 * 1.2 * 0.9, 0.01);
    const EnergyBalance e = half.solution.energy;
    EXPECT_NEAR((e.absorbed + e.escaped) / e.emitted, 1.0, 1e-4);
    EXPECT_EQ(e.escaped, 0.0);
    EXPECT_LT(half.solution.patch_radiosity.row(0)[0], 2.0) << "the screen takes some";
  }
}

// The light that a floor of one patch, whose picture is dark on one half and bright on the other,
// sends to a point 0.1 m above it, beside the line between the two, in 4096 rays. The irradiance is
// 1 on the floor and `behind` on its back, of which the floor passes `tau`.
constexpr float dark = 0.1f, bright = 0.8f;
constexpr double h = 0.1;
const Eigen::Vector3d near_line(1.0 + h, 1.0, h), down(0, 0, -1);

double light_of_picture(float tau, float behind) {
  Scene scene;
  Material grey = test::diffuse(scene.bands, 0.5f);
  if (tau > 0.0f) grey.transmittance = constant_spectrum(scene.bands, tau);
  grey.one_sided = !(tau > 0.0f);
  const int material = test::add_material(scene, grey);
  test::add_polygon(scene, "floor", material, {{0, 0, 0}, {2, 0, 0}, {2, 2, 0}, {0, 2, 0}});
  put_picture(scene, 0, picture_of(2, 1, {dark, bright}));
  const PatchMesh mesh = build_patches(scene, {.max_patch_size = 4.0});
  EXPECT_EQ(mesh.patch_count(), tau > 0.0f ? 2 : 1);
  const ElementCaster caster(mesh);
  const DirectLight light(scene, mesh);
  BandArray irradiance = BandArray::Ones(mesh.vertex_count(), scene.bands.count());
  const std::vector<int> patch = vertex_patches(mesh);
  for (int v = 0; v < mesh.vertex_count(); ++v) {
    if (mesh.is_back[patch[v]] != 0) irradiance.row(v).setConstant(behind);
  }
  const std::vector<GatherPoint> points = {{.position = near_line, .normal = down}};
  return gather_irradiance({scene, caster, light}, gatherable_radiosity(mesh, light, irradiance),
                           points, {.rays = 4096})
      .indirect(0, 0);
}

double form_factor_of_strip(double from, double to) {
  return point_to_polygon(near_line, down,
                          Loop{{from, 0, 0}, {to, 0, 0}, {to, 2, 0}, {from, 2, 0}});
}

// E = dark F_dark + bright F_bright. About 4 sqrt(4096) of the 4096 strata cross the line, each
// with a standard deviation of (bright - dark) / 2 at most, and as many the floor's edge, where
// rays are worth less by their cosine; the tolerance is four standard deviations.
constexpr double deviation = 0.5 * static_cast<double>(bright - dark);
const double of_strata = 4.0 * std::sqrt(2.0 * 4.0 * 64.0) / 4096.0;

TEST(Textures, LightNearAPictureIsThatOfThePicture) {
  const double expected = dark * form_factor_of_strip(0, 1) + bright * form_factor_of_strip(1, 2);
  EXPECT_NEAR(light_of_picture(0.0f, 0.0f), expected, deviation * of_strata);
}

// The sheet passes tau E_behind at every place alike. At the edge of the floor, which strata cross,
// light changes by that, too.
TEST(Textures, LightNearAPictureOnASheetIsThatOfThePicture) {
  constexpr float tau = 0.15f;
  for (const float behind : {0.0f, 1.0f, 5.0f}) {
    const double expected = dark * form_factor_of_strip(0, 1) +
                            bright * form_factor_of_strip(1, 2) +
                            double{tau * behind} * form_factor_of_strip(0, 2);
    EXPECT_NEAR(light_of_picture(tau, behind), expected,
                (deviation + 0.5 * double{tau * behind}) * of_strata)
        << behind;
  }
}

// A lamp so small and far that its shadows are sharp, over a plate with holes in two columns of
// four. The floor has the lamp's light, L A / d^2, where the straight line passes a hole, and none
// elsewhere.
TEST(Textures, ShadowsOfHolesAreTheHoles) {
  Scene scene;
  const int grey = test::add_material(scene, test::diffuse(scene.bands, 0.5f));
  Material lamp = test::diffuse(scene.bands, 0.0f, 1000.0f);
  test::add_polygon(scene, "floor", grey, {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}});
  test::add_polygon(scene, "plate", grey, {{0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}});
  test::add_polygon(scene, "lamp", test::add_material(scene, lamp),
                    {{0.49, 0.49, 101}, {0.49, 0.51, 101}, {0.51, 0.51, 101}, {0.51, 0.49, 101}});
  put_mask(scene, 1, picture_of(4, 1, {1, 0, 1, 0}));
  const PatchMesh mesh = build_patches(scene, {.max_patch_size = 0.25});
  const ElementCaster caster(mesh);
  const DirectLight light(scene, mesh);
  const double E_free = 1000.0 / std::numbers::pi * 0.02 * 0.02 / (101.0 * 101.0);
  for (int i = 0; i < 16; ++i) {
    const double x = (i + 0.5) / 16.0;
    // A line from the lamp at 101 m to x on the floor crosses the plate at 0.5 + (x - 0.5) 100/101.
    const double at_plate = 0.5 + (x - 0.5) * 100.0 / 101.0;
    const bool is_hole = static_cast<int>(4.0 * at_plate) % 2 == 1;
    const Spectrum E = light.irradiance(caster, {.at = {{x, 0.3, 0}, {0, 0, 1}, 0}, .key = 1});
    EXPECT_NEAR(E[0], is_hole ? E_free : 0.0, 1e-3 * E_free) << x;
  }
}

TEST(Textures, BitsDoNotDependOnTheNumberOfThreads) {
  Scene scene = parted_room({1, 0, 1, 0});
  put_picture(scene, 0, picture_of(2, 2, {0.2f, 0.8f, 0.6f, 0.4f}));
  const auto solved = [&](int threads) {
    const ThreadLimit limit(threads);
    return solve_scene(scene, quick(0.3)).solution;
  };
  const RadiositySolution one = solved(1);
  for (const int threads : {2, 3}) {
    const RadiositySolution other = solved(threads);
    EXPECT_TRUE((one.patch_radiosity == other.patch_radiosity).all());
    EXPECT_TRUE((one.indirect_irradiance == other.indirect_irradiance).all());
  }
}

}  // namespace
}  // namespace lightwell::textures_test
