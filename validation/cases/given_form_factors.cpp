#include "validation/cases/given_form_factors.h"

#include <fmt/format.h>

#include <algorithm>

#include "radiosity/solvers/solve_radiosity.h"

namespace lightwell {

MatrixFormFactors::MatrixFormFactors(const Eigen::ArrayXXd& F)
    : rows_(static_cast<std::size_t>(F.rows())) {
  for (int i = 0; i < F.rows(); ++i) {
    for (int j = 0; j < F.cols(); ++j) {
      if (F(i, j) <= 0.0) continue;
      rows_[static_cast<std::size_t>(i)].push_back({j, static_cast<float>(F(i, j))});
    }
  }
}

namespace {

// Form factors and reflectances are floats, 6e-8 each, and light is reflected 1 / (1 - rho) times.
double float_error(const KnownEnclosure& enclosure) {
  constexpr double roundings = 4 * 6e-8, solver = 1e-7;
  const double rho = std::min(0.99, static_cast<double>(enclosure.reflectance.maxCoeff()));
  return roundings / (1.0 - rho) + solver;
}

}  // namespace

ComparedValues solve_known_enclosure(const KnownEnclosure& enclosure) {
  PatchMesh mesh;
  mesh.area = enclosure.area;
  mesh.reflectance = enclosure.reflectance;
  mesh.emission = enclosure.emission;
  const MatrixFormFactors F(enclosure.F);
  const double error = float_error(enclosure);
  ComparedValues values;
  for (const NamedSolverMethod& solver : solver_methods) {
    const RadiositySolution solved =
        solve_radiosity(solver.method, mesh, F, {.tolerance = 1e-7, .max_sweeps = 20000});
    for (Eigen::Index i = 0; i < enclosure.radiosity.rows(); ++i) {
      for (Eigen::Index k = 0; k < enclosure.radiosity.cols(); ++k) {
        const auto B = static_cast<double>(enclosure.radiosity(i, k));
        const double largest = static_cast<double>(enclosure.radiosity.maxCoeff());
        values.push_back({.place = fmt::format("{}, surface {}", solver.name, i + 1),
                          .expected = B,
                          .computed = static_cast<double>(solved.patch_radiosity(i, k)),
                          .tolerance = error * largest});
      }
    }
  }
  return values;
}

}  // namespace lightwell
