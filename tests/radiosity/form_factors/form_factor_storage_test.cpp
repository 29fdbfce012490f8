// Form factors have the same bits wherever they are stored.
#include <gtest/gtest.h>

#include <cstring>

#include "mesh/build_patches.h"
#include "radiosity/form_factors/form_factors.h"
#include "radiosity/form_factors/view_factors.h"
#include "radiosity/solve.h"
#include "scene/parallel.h"
#include "tests/radiosity/named_methods.h"
#include "tests/radiosity/test_scenes.h"
#include "tests/temporary_folder.h"

namespace lightwell::form_factor_storage_test {
namespace {

using test::add_box;
using test::add_material;
using test::add_polygon;
using test::diffuse;

// Walls, a lamp with rows of its own, a floor that both mirrors and scatters, a tinted mirror, a
// block of glass and a ball that sees itself: all kinds of rows.
Scene room_of_everything() {
  Scene scene;
  const int wall = add_material(scene, diffuse(scene.bands, 0.5f));
  const int lamp = add_material(scene, diffuse(scene.bands, 0.0f, 10.0f));
  const int m = add_material(scene, test::tinted_mirror(scene.bands)),
            p = add_material(scene, test::polished(scene.bands)),
            g = add_material(scene, test::clear_glass(scene.bands));
  add_box(scene, {0, 0, 0}, {1.0, 1.2, 0.9}, {m, wall, wall, wall, p, wall}, true);
  add_box(scene, {0.3, 0.4, 0.1}, {0.6, 0.7, 0.5}, {g, g, g, g, g, g}, false);
  add_polygon(scene, "lamp", lamp,
              {{0.45, 0.45, 0.8}, {0.45, 0.55, 0.8}, {0.55, 0.55, 0.8}, {0.55, 0.45, 0.8}});
  scene.surfaces.push_back({.name = "ball",
                            .material = wall,
                            .shape = Sphere{.center = {0.8, 0.2, 0.3}, .radius = 0.1}});
  validate(scene);
  return scene;
}

// All numbers of a result.
std::vector<float> bits_of(const FormFactors& F) {
  std::vector<float> bits;
  for (int i = 0; i < F.patch_count(); ++i) {
    for (const FormFactor& f : F.row(i)) {
      bits.push_back(static_cast<float>(f.patch));
      bits.push_back(f.value);
    }
    const SpecularRow specular = F.specular_row(i);
    for (std::size_t k = 0; k < specular.patch.size(); ++k) {
      bits.push_back(static_cast<float>(specular.patch[k]));
      for (Eigen::Index band = 0; band < specular.value.cols(); ++band) {
        bits.push_back(specular.value(static_cast<Eigen::Index>(k), band));
      }
    }
    for (const Spectrum& lost : {F.escaped(i), F.absorbed_by_specular(i)}) {
      bits.insert(bits.end(), lost.begin(), lost.end());
    }
  }
  return bits;
}

struct Computed {
  std::vector<float> bits{};
  FormFactorReport report{};
  StorageReport storage{};
};

class Storage : public testing::TestWithParam<NamedFormFactorMethod> {
 protected:
  Computed compute(const Scene& scene, std::int64_t rows, int threads, double target_error) const {
    const ThreadLimit limit(threads);
    const PatchMesh mesh = build_patches(scene, {.max_patch_size = 0.2});
    const ElementCaster caster(mesh);
    const DirectLight direct_light(scene, mesh);
    FormFactorOptions options{.method = GetParam().method,
                              .rays_per_patch = 256,
                              .target_error = target_error,
                              .hemicube_resolution = 32};
    options.memory =
        std::make_shared<MemoryBudget>(MemoryOptions{.rows = rows, .folder = folder_ / ""});
    Computed computed;
    const auto F = compute_form_factors({scene, caster, direct_light}, options, &computed.report);
    computed.bits = bits_of(*F);
    computed.storage = options.memory->report();
    EXPECT_EQ(folder_.file_count(), 0);
    return computed;
  }
  TemporaryFolder folder_;
};

void expect_same(const Computed& a, const Computed& b) {
  ASSERT_EQ(a.bits.size(), b.bits.size());
  EXPECT_EQ(std::memcmp(a.bits.data(), b.bits.data(), a.bits.size() * sizeof(float)), 0);
  EXPECT_EQ(a.report.rays, b.report.rays);
  EXPECT_EQ(a.report.closed_forms, b.report.closed_forms);
  EXPECT_EQ(a.report.mean_closure_correction, b.report.mean_closure_correction);
  EXPECT_EQ(a.report.max_closure_error, b.report.max_closure_error);
  EXPECT_EQ(a.report.depth_cut, b.report.depth_cut);
  EXPECT_EQ(a.report.row_error, b.report.row_error);
}

TEST_P(Storage, ChangesNoBit) {
  const Scene scene = room_of_everything();
  // With a target error this number of patches is small enough for closed forms of all pairs.
  // Without one, "auto" mixes rays, near pairs and the lamp's rows.
  const Computed in_memory = compute(scene, -1, 2, 0.0);
  EXPECT_EQ(in_memory.storage.most_on_disk, 0);
  for (const auto& [rows, threads] : {std::pair{0, 1}, std::pair{80000, 3}}) {
    const Computed spilled = compute(scene, rows, threads, 0.0);
    EXPECT_GT(spilled.storage.most_on_disk, 0);
    EXPECT_LE(spilled.storage.most_in_memory, rows);
    expect_same(in_memory, spilled);
  }
  expect_same(compute(scene, -1, 1, 0.02), compute(scene, 40000, 3, 0.02));
}

INSTANTIATE_TEST_SUITE_P(Methods, Storage, testing::ValuesIn(form_factor_methods),
                         test::name_of_method);

// Reciprocity of the stored factors; also of the view factors whose rows are one patch each.
TEST_P(Storage, KeepsBothEndsOfEveryPair) {
  const Scene scene = test::furnace(0.5f, 1.0f, false);
  const PatchMesh mesh = build_patches(scene, {.max_patch_size = 0.2});
  const ElementCaster caster(mesh);
  const DirectLight direct_light(scene, mesh);
  FormFactorOptions options{.method = GetParam().method};
  options.memory =
      std::make_shared<MemoryBudget>(MemoryOptions{.rows = 50000, .folder = folder_ / ""});
  FormFactorReport report;
  const auto F = compute_form_factors({scene, caster, direct_light}, options, &report);
  const int n = mesh.patch_count();
  Eigen::MatrixXf stored = Eigen::MatrixXf::Zero(n, n), taken_over = stored;
  std::vector<int> row_of_patch;
  for (int i = 0; i < n; ++i) {
    row_of_patch.push_back(i);
    for (const FormFactor& f : F->row(i)) stored(i, f.patch) = f.value;
  }
  double worst = 0.0;
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) {
      const double A_i = mesh.area[i], A_j = mesh.area[j];
      worst =
          std::max(worst, std::abs(A_i * stored(i, j) - A_j * stored(j, i)) / std::min(A_i, A_j));
    }
  }
  EXPECT_EQ(worst, report.max_reciprocity_error);
  const ViewFactors view = sum_form_factors(*F, mesh, row_of_patch, n, options.memory);
  for (int i = 0; i < n; ++i) {
    EXPECT_TRUE(F->row(i).empty());
    for (const FormFactor& f : view.row(i)) taken_over(i, f.patch) = f.value;
  }
  EXPECT_EQ(stored, taken_over);
  EXPECT_EQ(reciprocity_error(view), worst);
  EXPECT_GT(options.memory->report().most_on_disk, 0);
}

TEST(SolveWithRowsOnDisk, IsTheSameSolution) {
  const Scene scene = room_of_everything();
  const TemporaryFolder folder;
  SolveOptions options{.mesh = {.max_patch_size = 0.15}, .gather = {.rays = 64}};
  const SolvedScene in_memory = solve_scene(scene, options);
  options.form_factors.memory =
      std::make_shared<MemoryBudget>(MemoryOptions{.rows = 0, .folder = folder / ""});
  const SolvedScene spilled = solve_scene(scene, options);
  EXPECT_GT(options.form_factors.memory->report().most_on_disk, 0);
  EXPECT_TRUE((in_memory.solution.patch_radiosity == spilled.solution.patch_radiosity).all());
  EXPECT_TRUE((in_memory.solution.irradiance() == spilled.solution.irradiance()).all());
}

}  // namespace
}  // namespace lightwell::form_factor_storage_test
