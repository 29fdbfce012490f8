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

// Receivers' sums over the light of sources, by a solve for each source and by a solve for each
// receiver: a mirror, whose shares differ by band, and a sheet that passes light to its other side.
// Light leaves an error of 1e-6 / (1 - rho) of its largest value, importance one of 1e-9 as for
// years of daylight; rows are reciprocal to float rounding, 6e-8 a factor, in each of some 30
// bounces.
TEST(SolveImportance, IsTheLightOfReceiversFromTheOtherSide) {
  Scene scene = test::room_with_mirror(0.7f);
  Material sheet = test::diffuse(scene.bands, 0.3f);
  sheet.transmittance = constant_spectrum(scene.bands, 0.4f);
  test::add_polygon(scene, "sheet", test::add_material(scene, sheet),
                    {{0.2, 0.3, 0.5}, {0.8, 0.3, 0.5}, {0.8, 0.7, 0.6}, {0.2, 0.7, 0.6}});
  const PatchMesh mesh = build_patches(scene, {.max_patch_size = 0.25});
  const ElementCaster caster(mesh);
  const DirectLight direct_light(scene, mesh);
  const auto F = compute_form_factors({scene, caster, direct_light}, {.rays_per_patch = 128});
  constexpr int sources = 3, receivers = 2, bands = 3;
  BandArray arriving = BandArray::Zero(mesh.patch_count(), sources * bands);
  BandArray received = BandArray::Zero(mesh.patch_count(), receivers * bands);
  for (Eigen::Index i = 0; i < arriving.rows(); ++i) {
    arriving.row(i).segment(i % sources * bands, bands) = static_cast<float>(1 + i % 5);
    received.row(i).segment(i % 7 % receivers * bands, bands) = static_cast<float>(1 + i % 11);
  }
  const auto product = [](const Eigen::ArrayXf& a, const Eigen::ArrayXf& b) {
    return (a.cast<double>() * b.cast<double>()).sum();
  };
  const BandArray B = solve_columns(mesh, *F, arriving, 1e-6),
                  w = solve_importance(mesh, *F, received, 1e-9);
  for (int s = 0; s < sources; ++s) {
    for (int r = 0; r < receivers; ++r) {
      for (int k = 0; k < bands; ++k) {
        const double forward = product(received.col(r * bands + k), B.col(s * bands + k)),
                     backward = product(w.col(r * bands + k), arriving.col(s * bands + k));
        EXPECT_NEAR(backward, forward, 1e-5 * forward) << s << ' ' << r << ' ' << k;
      }
    }
  }
}

}  // namespace lightwell::solve_columns_test
