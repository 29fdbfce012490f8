// All methods against the catalogue, and against closure and reciprocity.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>

#include "mesh/build_patches.h"
#include "mesh/geometry/cut_size.h"
#include "radiosity/form_factors/form_factors.h"
#include "scene/parallel.h"
#include "tests/radiosity/named_methods.h"
#include "tests/radiosity/test_scenes.h"
#include "tests/radiosity/view_factor_cases.h"

namespace lightwell::form_factor_methods_test {
namespace {

using test::add_box;
using test::add_material;
using test::add_polygon;
using test::diffuse;

struct Computed {
  PatchMesh mesh;
  std::unique_ptr<FormFactors> F;
  FormFactorReport report;
};

Computed compute(const Scene& scene, double patch_size, const FormFactorOptions& options) {
  Computed result;
  result.mesh = build_patches(scene, {.max_patch_size = patch_size});
  const ElementCaster caster(result.mesh);
  const DirectLight direct_light(scene, result.mesh);
  result.F = compute_form_factors({scene, caster, direct_light}, options, &result.report);
  return result;
}

// F from all patches of one surface to all of another.
double between(const Computed& c, int from, int to) {
  double exchanged = 0.0, area = 0.0;
  for (int i = 0; i < c.mesh.patch_count(); ++i) {
    if (c.mesh.surface[i] != from) continue;
    area += c.mesh.area[i];
    for (const FormFactor& f : c.F->row(i)) {
      if (c.mesh.surface[f.patch] == to) exchanged += c.mesh.area[i] * f.value;
    }
  }
  return exchanged / area;
}

Scene scene_of(const test::ViewFactorCase& c) {
  Scene scene;
  const int grey = add_material(scene, diffuse(scene.bands, 0.5f));
  Material two_sided = diffuse(scene.bands, 0.5f);
  two_sided.one_sided = false;
  const int screen = add_material(scene, two_sided);
  add_polygon(scene, "first", grey, c.first);
  add_polygon(scene, "second", grey, c.second);
  for (const auto& blocker : c.blockers) add_polygon(scene, "blocker", screen, blocker);
  validate(scene);
  return scene;
}

void expect_laws(const Computed& c, std::string_view name) {
  for (int i = 0; i < c.mesh.patch_count(); ++i) {
    float before = -1.0f;
    for (const FormFactor& f : c.F->row(i)) {
      ASSERT_TRUE(f.value >= 0.0f && f.value <= 1.0f + 1e-6f) << name;
      ASSERT_GT(f.patch, before) << name << ": columns rise";
      before = static_cast<float>(f.patch);
    }
  }
  EXPECT_LT(c.report.max_closure_error, 1e-5) << name;
  EXPECT_LT(c.report.max_reciprocity_error, 1e-6) << name;
}

// The hemicube needs many patches, so it is tested on one case of each kind.
bool is_for_hemicube(std::string_view name) {
  constexpr const char* names[] = {
      "par_unit_squares", "par_squares_d0_1",       "par_offset_disjoint", "perp_unit_common_edge",
      "perp_narrow",      "tri_tri_general",        "octa_edge",           "occ_square_corner_0_5",
      "occ_tri_rotated",  "occ_square_unit_blocker"};
  return std::find(std::begin(names), std::end(names), name) != std::end(names);
}

class Catalogue : public testing::TestWithParam<NamedFormFactorMethod> {};

TEST_P(Catalogue, IsMet) {
  const auto [name, method] = GetParam();
  const bool cast = method == FormFactorMethod::ray_cast;
  double worst = 0.0, worst_occluded = 0.0;
  for (const auto& c : test::view_factor_cases()) {
    FormFactorOptions options{.method = method};
    if (cast) options.rays_per_patch = 1 << 14;
    if (method == FormFactorMethod::automatic) options.target_error = 1e-3;
    const bool hemicube = method == FormFactorMethod::hemicube;
    if (hemicube && !is_for_hemicube(c.name)) continue;
    const Scene scene = scene_of(c);
    // The eye of a hemicube stands at the patch's centre, so patches must be small.
    const double patch = hemicube ? cut_size(scene, {.auto_patch_count = 1600}).patch_size : 1e3;
    const Computed computed = compute(scene, patch, options);
    expect_laws(computed, c.name);
    const double error = std::abs(between(computed, 0, 1) - c.F12);
    (c.blockers.empty() ? worst : worst_occluded) =
        std::max(c.blockers.empty() ? worst : worst_occluded, error);
    // Closed forms are exact without occluders, and good to 1e-6 behind polygons. The bounds of
    // rays and hemicube cells are their options' target and resolution.
    const bool exact =
        method == FormFactorMethod::analytic || method == FormFactorMethod::automatic;
    const double allowed = exact ? 1e-6 : c.blockers.empty() && cast ? 1e-3 : 2e-3;
    EXPECT_LE(error, allowed) << name << ", " << c.name << ": " << between(computed, 0, 1)
                              << " for " << c.F12;
  }
  std::printf("%s: worst error %.1e unoccluded, %.1e occluded\n", name.data(), worst,
              worst_occluded);
}

INSTANTIATE_TEST_SUITE_P(Methods, Catalogue, testing::ValuesIn(form_factor_methods),
                         test::name_of_method);

class Room : public testing::TestWithParam<NamedFormFactorMethod> {};

TEST_P(Room, WithABlockClosesAndSeesNothingThroughIt) {
  const auto [name, method] = GetParam();
  const Scene scene = test::furnace(0.5f, 1.0f, true);
  const Computed c = compute(scene, 0.3, {.method = method});
  expect_laws(c, name);
  for (int i = 0; i < c.mesh.patch_count(); ++i) {
    double sum = c.F->escaped(i)[0];
    for (const FormFactor& f : c.F->row(i)) sum += f.value;
    ASSERT_NEAR(sum, 1.0, 1e-5) << name << ", patch " << i;
    ASSERT_NEAR(c.F->escaped(i)[0], 0.0, 1e-6) << name << ": the room is closed";
  }
}

// Every surface has two sides, as thin walls have. A box in the corner of one room stands on its
// floor and touches two of its walls, with other subdivisions; the next room shares a wall.
TEST_P(Room, WithATouchingBoxAndARoomNextDoorClosesAndLeaksNothing) {
  const auto [name, method] = GetParam();
  Scene scene;
  Material wall = diffuse(scene.bands, 0.5f);
  wall.one_sided = false;
  const int m = add_material(scene, wall);
  const std::array<int, 6> all = {m, m, m, m, m, m};
  add_box(scene, {0, 0, 0}, {1.0, 1.2, 0.9}, all, true);
  add_box(scene, {1.0, 0, 0}, {1.8, 1.2, 0.9}, all, true);
  add_box(scene, {0, 0, 0}, {0.4, 0.5, 0.3}, all, false);
  const Computed c = compute(scene, 0.17, {.method = method});
  // Rays leak nothing. The centre of a hemicube's cell may lie on an edge at which all surfaces are
  // equally far. A closed form may use a part of its tolerance of 1e-6.
  const double cell = 4.0 / (std::numbers::pi * 256 * 256);
  const double leak = method == FormFactorMethod::hemicube   ? cell
                      : method == FormFactorMethod::analytic ? 1e-7
                                                             : 0.0;
  const auto room_of = [&](int patch) {  // 0, 1, 2: inside of the box; -1: outside of all
    const bool is_back = c.mesh.is_back[patch] != 0;
    const int body = c.mesh.surface[patch] / 6;
    return body == 2 ? (is_back ? 2 : 0) : is_back ? -1 : body;
  };
  for (int i = 0; i < c.mesh.patch_count(); ++i) {
    double sum = c.F->escaped(i)[0];
    for (const FormFactor& f : c.F->row(i)) {
      sum += f.value;
      if (room_of(i) != room_of(f.patch)) {
        ASSERT_LE(f.value, leak) << name << ": patches " << i << " and " << f.patch;
      }
    }
    ASSERT_NEAR(sum, 1.0, 1e-6) << name << ", patch " << i;
    if (room_of(i) < 0) continue;
    ASSERT_EQ(c.F->escaped(i)[0], 0.0) << name << ", patch " << i;
  }
}

TEST_P(Room, HasTheSameBitsForAnyNumberOfThreads) {
  const auto [name, method] = GetParam();
  const Scene scene = test::furnace(0.5f, 1.0f, true);
  std::vector<std::vector<float>> results;
  for (const int threads : {1, 2, 3}) {
    const ThreadLimit limit(threads);
    const Computed c = compute(scene, 0.4, {.method = method, .target_error = 4e-3});
    std::vector<float> values;
    for (int i = 0; i < c.mesh.patch_count(); ++i) {
      for (const FormFactor& f : c.F->row(i)) values.push_back(f.value);
    }
    results.push_back(values);
  }
  EXPECT_EQ(results[0], results[1]) << name;
  EXPECT_EQ(results[0], results[2]) << name;
}

// Few rays escape between near plates, or none; what the closed forms leave must escape anyway.
TEST(ClosedForms, KeepTheirValueHoweverFewRaysEscape) {
  for (const double L : {50.0, 700.0, 1000.0, 3000.0, 1e5}) {
    Scene scene;
    const int grey = add_material(scene, diffuse(scene.bands, 0.5f));
    add_polygon(scene, "floor", grey, {{0, 0, 0}, {L, 0, 0}, {L, L, 0}, {0, L, 0}});
    add_polygon(scene, "ceiling", grey, {{0, 0, 1}, {0, L, 1}, {L, L, 1}, {L, 0, 1}});
    validate(scene);
    const double hypotenuse = std::sqrt(1.0 + L * L);
    const double F = 2.0 / (std::numbers::pi * L * L) *
                     (std::log(hypotenuse * hypotenuse / std::sqrt(1.0 + 2.0 * L * L)) +
                      2.0 * L * hypotenuse * std::atan(L / hypotenuse) - 2.0 * L * std::atan(L));
    for (const auto method : {FormFactorMethod::automatic, FormFactorMethod::analytic}) {
      const bool is_cut = method == FormFactorMethod::analytic;
      const Computed c =
          compute(scene, is_cut ? L / 8.0 : 2.0 * L, {.method = method, .target_error = 1e-3});
      expect_laws(c, "plates");
      // Exchange, scaling and factor are rounded to floats: 3 times 2^-24. The exchange of patches
      // that are many gaps apart is below a millionth, so its relative error does not count.
      EXPECT_NEAR(between(c, 0, 1), F, 3 * 0x1p-24) << "L = " << L << ", cut: " << is_cut;
      for (const float error : c.report.row_error) {
        EXPECT_GT(error, 0.0f) << "rounding at least";
        EXPECT_LT(error, 1e-6f) << "the closed form's error, and rounding";
      }
      for (const float bias : c.report.row_bias) {
        EXPECT_GT(bias, 0.0f);
        EXPECT_LE(bias, 1e-5f) << "the area integral's bound, for rows that sum to 1";
      }
    }
  }
}

// Patches of spheres have no closed form, so rays are added until they meet the target, too.
TEST(AnalyticFormFactors, MeetATargetWithSpheres) {
  constexpr double target = 4e-3;
  Scene scene = test::furnace(0.5f, 1.0f, false);
  scene.surfaces.push_back({.name = "ball", .material = 0, .shape = Sphere{{0.5, 0.6, 0.45}, 0.2}});
  const Computed c =
      compute(scene, 0.6, {.method = FormFactorMethod::analytic, .target_error = target});
  double worst = 0.0;
  for (const float error : c.report.row_error) worst = std::max(worst, static_cast<double>(error));
  EXPECT_GT(worst, 0.0);
  EXPECT_LE(worst, target);
  EXPECT_GT(c.report.rays / c.mesh.patch_count(), FormFactorOptions{}.rays_per_patch);
  // All light that leaves the ball arrives at the walls, so the ball's share of their rows follows
  // from reciprocity.
  const int ball = static_cast<int>(scene.surfaces.size()) - 1;
  double to_ball = 0.0, area = 0.0;
  for (int i = 0; i < c.mesh.patch_count(); ++i) {
    if (c.mesh.surface[i] == ball) {
      area += c.mesh.area[i];
      continue;
    }
    for (const FormFactor& f : c.F->row(i)) {
      if (c.mesh.surface[f.patch] == ball) to_ball += c.mesh.area[i] * f.value;
    }
  }
  EXPECT_NEAR(to_ball / area, 1.0, target);
}

// Too many patches for closed forms of all pairs. Partly hidden near pairs must not need ever more
// rays.
TEST(AutomaticFormFactors, MeetATargetWithFewRaysWherePolygonsHideEachOther) {
  const Scene scene = test::furnace(0.5f, 1.0f, true);
  constexpr double target = 5e-3, patch = 0.09;
  const Computed automatic = compute(scene, patch, {.target_error = target});
  const Computed exact =
      compute(scene, patch, {.method = FormFactorMethod::analytic, .target_error = target});
  const int n = exact.mesh.patch_count();
  ASSERT_GT(automatic.report.rays, 0);
  EXPECT_LE(automatic.report.rays, 1.5 * 1024 * n);  // 3.32 / target, to a power of two
  double worst = 0.0, signed_sum = 0.0, squares = 0.0;
  for (int i = 0; i < n; ++i) {
    EXPECT_LE(automatic.report.row_error[i], target) << "row " << i;
    std::vector<double> difference(static_cast<std::size_t>(n), 0.0);
    for (const FormFactor& f : automatic.F->row(i)) difference[f.patch] += f.value;
    for (const FormFactor& f : exact.F->row(i)) difference[f.patch] -= f.value;
    for (const double d : difference) {
      worst = std::max(worst, std::abs(d));
      squares += d * d;
      signed_sum += d;
    }
  }
  const double rms = std::sqrt(squares / (static_cast<double>(n) * n));
  std::printf("auto against analytic, %d patches: RMS %.1e, worst %.1e\n", n, rms, worst);
  EXPECT_LT(rms, 0.2 * target);  // few pairs are as uncertain as the worst
  // The largest of 1e6 normal draws with the worst variance.
  EXPECT_LT(worst, 5.0 * target);
  EXPECT_NEAR(signed_sum / n, 0.0, 1e-6);  // both matrices close
}

INSTANTIATE_TEST_SUITE_P(Methods, Room, testing::ValuesIn(form_factor_methods),
                         test::name_of_method);

}  // namespace
}  // namespace lightwell::form_factor_methods_test
