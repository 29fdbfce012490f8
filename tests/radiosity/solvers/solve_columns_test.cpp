#include "radiosity/solvers/solve_columns.h"

#include <gtest/gtest.h>

#include "mesh/build_patches.h"
#include "tests/radiosity/test_scenes.h"

namespace lightwell::solve_columns_test {

// More columns than fit into a block, one of them dark and one a million times as bright, each as a
// solve of its own. A mirror gives the rows shares by band. Both solves leave an error of 1e-5.
TEST(SolveColumns, AreSolvesOfTheirOwn) {
  const Scene scene = test::room_with_mirror(0.7f);
  const PatchMesh mesh = build_patches(scene, {.max_patch_size = 0.5});
  const ElementCaster caster(mesh);
  const DirectLight direct_light(scene, mesh);
  const auto form_factors =
      compute_form_factors({scene, caster, direct_light}, {.rays_per_patch = 128});
  constexpr int columns = 40, bands = 3;
  BandArray arriving(mesh.patch_count(), columns * bands);
  for (Eigen::Index i = 0; i < arriving.rows(); ++i) {
    for (Eigen::Index k = 0; k < arriving.cols(); ++k) {
      arriving(i, k) = static_cast<float>((i * 7 + k * 13) % 31) / 31.0f;
    }
  }
  arriving.middleCols(3 * bands, bands).setZero();
  arriving.middleCols(35 * bands, bands) *= 1e6f;
  const BandArray B = solve_columns(mesh, *form_factors, arriving, 1e-5);
  EXPECT_EQ(B.middleCols(3 * bands, bands).abs().maxCoeff(), 0.0f);
  PatchMesh dark = mesh;
  dark.emission.setZero();
  for (const int c : {0, 31, 32, 35, 39}) {
    SolverOptions options{.tolerance = 1e-5};
    options.arriving = arriving.middleCols(c * bands, bands);
    const BandArray alone =
        solve_radiosity(SolverMethod::automatic, dark, *form_factors, options).patch_radiosity;
    const float largest = alone.maxCoeff();
    EXPECT_LT((B.middleCols(c * bands, bands) - alone).abs().maxCoeff(), 2e-5f * largest)
        << "column " << c;
  }
}

}  // namespace lightwell::solve_columns_test
