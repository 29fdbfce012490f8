#include "radiosity/solvers/solver_run.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "radiosity/journal/journal.h"
#include "scene/errors.h"

namespace lightwell {
namespace {

// Rows sum to 1 within the rounding of floats, so smaller absorption is indistinguishable from
// none.
constexpr double least_absorption = 1e-6;

const PatchMesh& checked(const PatchMesh& mesh, const SolverOptions& options) {
  for (int i = 0; i < mesh.patch_count(); ++i) {
    if (!(mesh.area[i] > 0.0)) {
      throw std::invalid_argument(fmt::format("patch {} has area {}", i, mesh.area[i]));
    }
  }
  if (!(options.tolerance > 0.0) || options.max_sweeps < 1) {
    throw std::invalid_argument(
        fmt::format("a solver needs a tolerance above 0 and 1 sweep, not {} and {}",
                    options.tolerance, options.max_sweeps));
  }
  if (!(options.relaxation >= 0.0 && options.relaxation < 2.0) || options.gmres_restart < 1) {
    throw std::invalid_argument(
        fmt::format("relaxation {} is not in [0, 2), or gmres_restart {} is below 1",
                    options.relaxation, options.gmres_restart));
  }
  const BandArray& E0 = options.arriving;
  if (E0.size() > 0 && (E0.rows() != mesh.emission.rows() || E0.cols() != mesh.emission.cols() ||
                        !E0.allFinite() || !(E0 >= 0.0f).all())) {
    throw std::invalid_argument(
        fmt::format("the irradiance that arrives must be {} x {} finite numbers >= 0",
                    mesh.emission.rows(), mesh.emission.cols()));
  }
  const BandArray& B = options.start;
  if (B.size() == 0) return mesh;
  if (B.rows() != mesh.emission.rows() || B.cols() != mesh.emission.cols() || !B.allFinite()) {
    throw std::invalid_argument(
        fmt::format("the radiosities to start from must be {} x {} finite numbers",
                    mesh.emission.rows(), mesh.emission.cols()));
  }
  return mesh;
}

}  // namespace

SolverRun::SolverRun(const PatchMesh& mesh, const FormFactors& form_factors,
                     const SolverOptions& solver_options)
    : system(
          checked(mesh, solver_options), form_factors,
          [this] { report(options.run.progress, "solve", share_); }, solver_options.arriving),
      options(solver_options),
      groups(form_factors, mesh.behind) {
  find_ends();
}

void SolverRun::keep_passes(SolverMethod method) {
  if (!options.run.journal) return;
  // A product with F is part of the fingerprint, so other form factors have another fingerprint.
  const LightVector E = system.product(system.albedo + system.M);
  const JournalPhase phase(options.run, "passes", [&](Fingerprint& print) {
    print.add(method);
    print.add(options.relaxation);
    print.add(options.gmres_restart);
    print.add(options.start);
    print.add(system.area);
    print.add(system.M);
    print.add(system.rho);
    print.add(system.tau);
    print.add(E);
  });
  passes_.emplace(phase, options.run.journal->every());
  system.keep_passes(&*passes_);
}

// Error bound of each group and band, |error of B| <= |residual| / (1 - rho_max). Throws InputError
// where a lit group absorbs nothing.
void SolverRun::find_ends() {
  const LightVector &M = system.M, &rho = system.albedo;
  LightVector rho_max = LightVector::Zero(groups.count, system.lanes());
  LightVector emission = rho_max;
  for (int i = 0; i < system.patch_count(); ++i) {
    const int g = groups.group_of[i];
    rho_max.row(g) = rho_max.row(g).max(rho.row(i));
    emission.row(g) += system.area[i] * M.row(i);
  }
  error_per_residual_ =
      (emission > 0.0).select((rho_max < 1.0).select(1.0 / (1.0 - rho_max), 1.0), 0.0);
  if (!(error_per_residual_ > 0.0 && rho_max > 1.0 - least_absorption).any()) return;

  // Loss of uniform light at its first reflection.
  const LightVector uniform = (rho > 0.0).cast<double>();
  const LightVector lost = system.product(uniform);
  LightVector loss = LightVector::Zero(groups.count, system.lanes()), area = loss;
  for (int i = 0; i < system.patch_count(); ++i) {
    loss.row(groups.group_of[i]) += system.area[i] * lost.row(i);
    area.row(groups.group_of[i]) += system.area[i] * uniform.row(i);
  }
  for (int i = 0; i < system.patch_count(); ++i) {
    const int g = groups.group_of[i];
    for (int k = 0; k < system.bands(); ++k) {
      const bool is_lit = emission(g, k) > 0.0 && area(g, k) > 0.0;
      if (is_lit && !(loss(g, k) > least_absorption * area(g, k))) refuse_endless(i, k);
    }
  }
}

void SolverRun::refuse_endless(int patch, int lane) const {
  throw InputError(fmt::format(
      "light never ends around {}: all that exchange light with it reflect all of band {} and "
      "nothing gets out, so there is no finite answer; give one of their materials a reflectance "
      "below 1, or take the light out",
      options.name_of ? options.name_of(patch) : fmt::format("patch {}", patch), lane + 1));
}

LightVector SolverRun::start() const {
  if (options.start.size() == 0) return system.M;
  LightVector B = system.basic(options.start);
  for (int i = 0; i < system.patch_count(); ++i) {
    const auto is_lit = error_per_residual_.row(groups.group_of[i]) > 0.0;
    B.row(i) = is_lit.select((system.albedo.row(i) > 0.0).select(B.row(i), system.M.row(i)), 0.0);
  }
  return B;
}

bool SolverRun::should_continue(SolverMethod method, const LightVector& B,
                                const LightVector& residual) {
  double largest = 0.0, worst = 0.0, bound = 0.0;
  bool is_finite = true;
  for (int i = 0; i < system.patch_count(); ++i) {
    const auto r = residual.row(i).abs();
    is_finite = is_finite && B.row(i).allFinite() && residual.row(i).allFinite();
    // M is included because B may start at 0 and is never below M.
    largest = std::max({largest, B.row(i).abs().maxCoeff(), system.M.row(i).maxCoeff()});
    worst = std::max(worst, r.maxCoeff());
    bound = std::max(bound, (r * error_per_residual_.row(groups.group_of[i])).maxCoeff());
  }
  if (!is_finite) {
    throw std::runtime_error(
        "The radiosities are no longer finite numbers; please report the scene.");
  }
  const auto relative = [&](double value) { return largest > 0.0 ? value / largest : 0.0; };
  history_.push_back(
      {.residual = relative(worst),
       .seconds =
           std::chrono::duration<double>(std::chrono::steady_clock::now() - begun_).count()});
  const double excess = relative(bound) / options.tolerance;
  const int sweeps = static_cast<int>(history_.size());
  if (sweeps == 1) first_excess_ = excess;
  if (options.observer) {
    options.observer({.number = sweeps,
                      .method = method,
                      .record = history_.back(),
                      .radiosity = system.without_index(B)});
  }
  const bool is_done = excess <= 1.0;
  outcome_ = is_done ? Outcome::converged : Outcome::max_sweeps_reached;

  // Residuals fall about geometrically.
  const double fallen =
      is_done ? 1.0 : std::log(first_excess_ / excess) / std::log(std::max(first_excess_, 2.0));
  share_ = std::max({share_, std::min(fallen, 1.0),
                     std::min(1.0, static_cast<double>(sweeps) / options.max_sweeps)});
  report(options.run.progress, "solve", share_);
  return !is_done && sweeps < options.max_sweeps;
}

}  // namespace lightwell
