#pragma once

#include <gtest/gtest.h>

#include <cstring>
#include <memory>

#include "radiosity/solve.h"
#include "tests/radiosity/test_scenes.h"

/// Solves that take a moment, by every method, for tests that stop them or share their work.
namespace lightwell::quick_solves {

// A block under a lamp; optionally a mirror, and a glass ball with a caustic.
inline Scene room(bool with_specular) {
  Scene scene;
  const int white = test::add_material(scene, test::diffuse(scene.bands, 0.7f));
  Material lamp_material = test::diffuse(scene.bands, 0.1f);
  lamp_material.emission << 20.0f, 15.0f, 10.0f;
  const int lamp = test::add_material(scene, lamp_material);
  int wall = white;
  if (with_specular) wall = test::add_material(scene, test::tinted_mirror(scene.bands));
  test::add_box(scene, {0, 0, 0}, {2, 3, 2.5}, {wall, white, white, white, white, white}, true);
  test::add_polygon(scene, "lamp", lamp,
                    {{0.8, 1.2, 2.4}, {0.8, 1.8, 2.4}, {1.2, 1.8, 2.4}, {1.2, 1.2, 2.4}});
  test::add_box(scene, {0.4, 0.5, 0.0}, {0.9, 1.1, 0.8}, {white, white, white, white, white, white},
                false);
  if (with_specular) {
    const int glass = test::add_material(scene, test::clear_glass(scene.bands));
    scene.surfaces.push_back(
        {.name = "ball", .material = glass, .shape = Sphere{{1.4, 2.2, 0.6}, 0.3}});
  }
  return scene;
}

inline SolveOptions quick() {
  SolveOptions options;
  options.mesh.max_patch_size = 0.5;
  options.form_factors.rays_per_patch = 64;
  options.gather.rays = 32;
  options.caustic_rays = 1 << 12;
  options.error_points = 64;
  options.refine.tolerance = 0.05;
  return options;
}

struct Case {
  const char* name;
  bool with_specular;
  void (*set)(SolveOptions&);
};

inline const Case cases[] = {
    {"AsUsual", false, [](SolveOptions&) {}},
    {"MirrorAndCaustics", true, [](SolveOptions&) {}},
    {"EvenMesh", true, [](SolveOptions& o) { o.refine.tolerance = 0.0; }},
    {"RaysGaussSeidel", true,
     [](SolveOptions& o) {
       o.form_factors.method = FormFactorMethod::ray_cast;
       o.solver_method = SolverMethod::gauss_seidel;
     }},
    {"HemicubeJacobi", true,
     [](SolveOptions& o) {
       o.form_factors.method = FormFactorMethod::hemicube;
       o.form_factors.hemicube_resolution = 32;
       o.solver_method = SolverMethod::jacobi;
     }},
    {"AnalyticSouthwell", false,
     [](SolveOptions& o) {
       o.form_factors.method = FormFactorMethod::analytic;
       o.solver_method = SolverMethod::southwell;
     }},
    {"AccuracyGmres", false,
     [](SolveOptions& o) {
       o.form_factors.target_error = 0.02;
       o.solver_method = SolverMethod::gmres;
     }},
    {"Sor", false, [](SolveOptions& o) { o.solver_method = SolverMethod::sor; }},
    {"Bicgstab", true, [](SolveOptions& o) { o.solver_method = SolverMethod::bicgstab; }},
    {"Progressive", true,
     [](SolveOptions& o) {
       o.progressive = {.tolerance = 0.01, .rays = 1 << 14, .overshooting = Overshooting::ambient};
     }},
    {"RowsOnDisk", true, [](SolveOptions& o) {
       o.form_factors.memory =
           std::make_shared<MemoryBudget>(MemoryOptions{.rows = 1 << 14, .folder = "."});
     }}};

inline void expect_same_bits(const BandArray& a, const BandArray& b, const char* what) {
  ASSERT_EQ(a.rows(), b.rows()) << what;
  ASSERT_EQ(a.cols(), b.cols()) << what;
  if (a.size() == 0) return;
  EXPECT_EQ(std::memcmp(a.data(), b.data(), sizeof(float) * static_cast<std::size_t>(a.size())), 0)
      << what;
}

inline void expect_same_solve(const SolvedScene& a, const SolvedScene& b) {
  const RadiositySolution &x = a.solution, &y = b.solution;
  expect_same_bits(x.patch_radiosity, y.patch_radiosity, "patch radiosity");
  expect_same_bits(x.direct_irradiance, y.direct_irradiance, "direct");
  expect_same_bits(x.indirect_irradiance, y.indirect_irradiance, "indirect");
  expect_same_bits(x.caustic_irradiance, y.caustic_irradiance, "caustic");
  expect_same_bits(x.interpolation_error, y.interpolation_error, "interpolation error");
  expect_same_bits(x.gather_noise, y.gather_noise, "gather noise");
  EXPECT_EQ(a.mesh.corners, b.mesh.corners);
  EXPECT_EQ(x.solver, y.solver);
  EXPECT_EQ(x.outcome, y.outcome);
  EXPECT_EQ(x.residual, y.residual);
  EXPECT_EQ(x.history.size(), y.history.size());
  EXPECT_EQ(x.error_estimate, y.error_estimate);
  EXPECT_EQ(x.provenance.refinement, y.provenance.refinement);
  EXPECT_EQ(x.energy.emitted, y.energy.emitted);
  EXPECT_EQ(x.energy.absorbed, y.energy.absorbed);
  EXPECT_EQ(x.energy.escaped, y.energy.escaped);
  EXPECT_EQ(x.energy.unshot, y.energy.unshot);
}

}  // namespace lightwell::quick_solves
