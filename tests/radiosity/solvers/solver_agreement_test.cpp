// All solvers on the form factors of real scenes: the same solution wherever rows are stored, and
// the same bits for any number of threads.
#include <gtest/gtest.h>

#include <cstring>

#include "mesh/build_patches.h"
#include "radiosity/solve.h"
#include "scene/io/read_scene.h"
#include "scene/parallel.h"
#include "tests/radiosity/named_methods.h"
#include "tests/radiosity/test_scenes.h"
#include "tests/temporary_folder.h"

namespace lightwell::solver_agreement_test {
namespace {

using test::add_box;
using test::add_material;
using test::add_polygon;
using test::diffuse;

struct Solvable {
  Scene scene{};
  PatchMesh mesh{};
  std::shared_ptr<MemoryBudget> memory{};
  std::unique_ptr<FormFactors> F{};
};

Solvable prepare(Scene scene, double patch, const MemoryOptions& memory = {}) {
  Solvable s{.scene = std::move(scene), .memory = std::make_shared<MemoryBudget>(memory)};
  s.mesh = build_patches(s.scene, {.max_patch_size = patch});
  const ElementCaster caster(s.mesh);
  const DirectLight direct_light(s.scene, s.mesh);
  s.F = compute_form_factors({s.scene, caster, direct_light},
                             {.rays_per_patch = 256, .memory = s.memory});
  return s;
}

void add_lamp(Scene& scene, const Eigen::Vector3d& at, float exitance) {
  Material lamp = diffuse(scene.bands, 0.1f, exitance);
  lamp.emission[1] *= 0.7f;
  lamp.emission[2] *= 0.4f;
  const Eigen::Vector3d x(0.2, 0, 0), y(0, 0.2, 0);
  add_polygon(scene, "lamp", add_material(scene, lamp), {at, at + y, at + x + y, at + x});
}

// A room with a tinted mirror as a wall, a floor that both mirrors and scatters, and a block of
// glass.
Scene mirror_room() {
  Scene scene;
  Material red = diffuse(scene.bands, 0.8f);
  red.reflectance << 0.8f, 0.1f, 0.0f;
  const int m = add_material(scene, test::tinted_mirror(scene.bands)),
            p = add_material(scene, test::polished(scene.bands)),
            g = add_material(scene, test::clear_glass(scene.bands)), r = add_material(scene, red),
            wall = add_material(scene, diffuse(scene.bands, 0.7f));
  add_box(scene, {0, 0, 0}, {1.0, 1.2, 0.9}, {m, r, wall, wall, p, wall}, true);
  add_box(scene, {0.3, 0.4, 0.1}, {0.6, 0.7, 0.5}, {g, g, g, g, g, g}, false);
  add_lamp(scene, {0.4, 0.5, 0.85}, 10.0f);
  return scene;
}

// A lit room, an unlit room of reflectance 1, and a small room with a millionth of the light.
Scene rooms_apart() {
  Scene scene;
  const int grey = add_material(scene, diffuse(scene.bands, 0.6f)),
            white = add_material(scene, diffuse(scene.bands, 1.0f));
  add_box(scene, {0, 0, 0}, {1, 1, 1}, {grey, grey, grey, grey, grey, grey}, true);
  add_lamp(scene, {0.4, 0.4, 0.95}, 10.0f);
  add_box(scene, {2, 0, 0}, {3, 1, 1}, {white, white, white, white, white, white}, true);
  add_box(scene, {4, 0, 0}, {5, 1, 1}, {grey, grey, grey, grey, grey, grey}, true);
  add_lamp(scene, {4.4, 0.4, 0.95}, 1e-5f);
  return scene;
}

constexpr double tolerance = 1e-6;

RadiositySolution solve(const Solvable& s, SolverMethod method) {
  const auto solution =
      solve_radiosity(method, s.mesh, *s.F, {.tolerance = tolerance, .max_sweeps = 5000});
  EXPECT_EQ(solution.outcome, Outcome::converged) << solver_name(method);
  return solution;
}

// Both solutions are within the tolerance of the true one, and rounded to float. `closure_error`:
// closure error of the rows.
void expect_agreement(const Solvable& s, double closure_error) {
  const BandArray B = solve(s, SolverMethod::gauss_seidel).patch_radiosity;
  ASSERT_GT(B.maxCoeff(), 0.0f);
  for (const auto& [name, method] : solver_methods) {
    const auto solution = solve(s, method);
    const double off = (solution.patch_radiosity - B).abs().maxCoeff() / B.maxCoeff();
    EXPECT_LT(off, 2 * tolerance + 1.2e-7) << name;
    const EnergyBalance energy = energy_balance(s.scene, s.mesh, *s.F, solution.patch_radiosity);
    const double most = s.mesh.area.sum() * static_cast<double>(B.maxCoeff()) * B.cols();
    EXPECT_LT(std::abs(energy.unshot), (tolerance + 1.2e-7) * most) << name;
    const double fates = energy.absorbed + energy.escaped + energy.unshot;
    EXPECT_NEAR(fates / energy.emitted, 1.0, closure_error) << name;
  }
}

TEST(SolverAgreement, OnTheCornellBox) {
  expect_agreement(prepare(read_scene(LIGHTWELL_CORNELL "/cornell.toml"), 0.08), 1e-6);
}

TEST(SolverAgreement, InARoomOfMirrorsAndGlass) {
  const Solvable s = prepare(mirror_room(), 0.15);
  std::size_t specular = 0;
  for (int i = 0; i < s.mesh.patch_count(); ++i) specular += s.F->specular_row(i).patch.size();
  ASSERT_GT(specular, 1000u);
  expect_agreement(s, 1e-3);  // error of the light through mirrors and glass, from 256 rays
  // Stored exchange through mirrors is as reciprocal as direct exchange.
  EXPECT_EQ(solve(s, SolverMethod::automatic).solver, "cg");
}

TEST(SolverAgreement, InRoomsApart) {
  const Solvable s = prepare(rooms_apart(), 0.25);
  expect_agreement(s, 1e-6);
  for (const auto& [name, method] : solver_methods) {
    const BandArray B = solve(s, method).patch_radiosity;
    for (int i = 0; i < s.mesh.patch_count(); ++i) {
      const double x = element_center(s.mesh, s.mesh.first_element[i]).position.x();
      if (x > 1.5 && x < 3.5) {
        ASSERT_EQ(B.row(i).abs().maxCoeff(), 0.0f) << name;
      }
    }
  }
}

class SameBits : public testing::TestWithParam<NamedSolverMethod> {};

TEST_P(SameBits, ForAnyThreadsAndAnyMemory) {
  const TemporaryFolder folder;
  const MemoryOptions on_disk{.rows = 60000, .folder = folder / ""};
  const Solvable kept = prepare(mirror_room(), 0.15),
                 spilled = prepare(mirror_room(), 0.15, on_disk);
  ASSERT_EQ(kept.memory->report().most_on_disk, 0);
  ASSERT_GT(spilled.memory->report().most_on_disk, 100000);
  const BandArray B = solve(kept, GetParam().method).patch_radiosity;
  for (int threads = 1; threads <= 5; ++threads) {
    const ThreadLimit limit(threads);
    const BandArray again =
        solve(threads % 2 == 0 ? kept : spilled, GetParam().method).patch_radiosity;
    ASSERT_EQ(std::memcmp(again.data(), B.data(), sizeof(float) * B.size()), 0) << threads;
  }
}
INSTANTIATE_TEST_SUITE_P(Methods, SameBits, testing::ValuesIn(solver_methods),
                         test::name_of_solver);

}  // namespace
}  // namespace lightwell::solver_agreement_test
