#include "radiosity/solvers/solve_radiosity.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <stdexcept>
#include <utility>
#include <vector>

#include "radiosity/solvers/solvers.h"
#include "scene/errors.h"

namespace lightwell {
namespace {

// Tolerance for reciprocity: far above the rounding of floats in joined estimates and stores, far
// below an asymmetry that would affect results.
constexpr double most_asymmetry = 1e-4;

// Without mirrors and glass, FormFactors guarantees reciprocity; otherwise reciprocity is measured.
double asymmetry(const RadiositySystem& system) {
  return system.has_specular_rows() ? system.asymmetry() : 0.0;
}

// The effective method. Measured on rooms from dark to nearly closed and white, conjugate gradients
// take the fewest passes over the rows (solver_bench).
SolverMethod chosen(const SolverRun& run, SolverMethod asked) {
  const bool needs_reciprocity = asked == SolverMethod::automatic ||
                                 asked == SolverMethod::conjugate_gradients ||
                                 asked == SolverMethod::southwell;
  if (!needs_reciprocity) return asked;
  const double found = asymmetry(run.system);
  const bool is_reciprocal = found < most_asymmetry;
  // The matrix is not positive definite where a sheet passes more light than it reflects.
  const bool is_definite = !run.system.is_translucent();
  if (asked == SolverMethod::automatic) {
    return is_reciprocal && is_definite ? SolverMethod::conjugate_gradients
                                        : SolverMethod::bicgstab;
  }
  if (asked == SolverMethod::conjugate_gradients && !is_definite) {
    throw InputError(fmt::format(
        "the solver '{}' does not solve for translucent materials, whose sides exchange light; use "
        "'bicgstab', 'gmres' or 'gauss-seidel'",
        solver_name(asked)));
  }
  if (is_reciprocal) return asked;
  throw InputError(fmt::format(
      "the solver '{}' needs form factors with A_i F_ij = A_j F_ji, and what goes by way of "
      "mirrors and glass here is off by {:.2g} of itself; use 'bicgstab' or 'gmres', which do not "
      "need that",
      solver_name(asked), found));
}

LightVector solve(SolverRun& run, SolverMethod method) {
  switch (method) {
    case SolverMethod::gauss_seidel:
      return solve_by_gauss_seidel(run);
    case SolverMethod::jacobi:
      return solve_by_jacobi(run);
    case SolverMethod::sor:
      return solve_by_sor(run);
    case SolverMethod::southwell:
      return solve_by_southwell(run);
    case SolverMethod::automatic:  // never returned by chosen()
    case SolverMethod::conjugate_gradients:
      return solve_by_conjugate_gradients(run);
    case SolverMethod::bicgstab:
      return solve_by_bicgstab(run);
    case SolverMethod::gmres:
      return solve_by_gmres(run);
  }
  return {};
}

}  // namespace

SolverMethod solver_method(std::string_view name) {
  std::vector<std::string_view> names;
  for (const NamedSolverMethod& known : solver_methods) {
    if (known.name == name) return known.method;
    names.push_back(known.name);
  }
  throw std::invalid_argument(
      fmt::format("there is no solver '{}'; there are {}", name, fmt::join(names, ", ")));
}

std::string_view solver_name(SolverMethod method) {
  for (const NamedSolverMethod& known : solver_methods) {
    if (known.method == method) return known.name;
  }
  return {};
}

BandArray gather(const FormFactors& form_factors, const BandArray& radiosity) {
  const RowGather rows(form_factors, static_cast<int>(radiosity.cols()));
  const Eigen::ArrayXd squared_index = form_factors.squared_index();
  const bool has_bodies = squared_index.size() > 0;
  LightVector B = rows.with_lanes(radiosity);
  if (has_bodies) B.colwise() /= squared_index;
  LightVector E = rows.all(B);
  if (has_bodies) E.colwise() *= squared_index;
  return rows.without_lanes(E);
}

RadiositySolution solve_radiosity(SolverMethod method, const PatchMesh& mesh,
                                  const FormFactors& form_factors, const SolverOptions& options) {
  SolverRun run(mesh, form_factors, options);
  method = chosen(run, method);
  run.keep_passes(method);
  LightVector B = solve(run, method);
  RadiositySolution solution;
  solution.patch_radiosity = run.system.without_index(std::move(B));
  solution.solver = solver_name(method);
  solution.history = run.history();
  solution.residual = solution.history.back().residual;
  solution.outcome = run.outcome();
  return solution;
}

}  // namespace lightwell
