#pragma once

#include <chrono>
#include <optional>

#include "radiosity/solvers/exchange_groups.h"
#include "radiosity/solvers/radiosity_system.h"
#include "radiosity/solvers/solve_radiosity.h"

namespace lightwell {

/// State common to all solvers: start, stopping criterion and history.
class SolverRun {
 public:
  /// Throws as solve_radiosity for wrong input.
  SolverRun(const PatchMesh& mesh, const FormFactors& form_factors, const SolverOptions& options);
  SolverRun(const SolverRun&) = delete;
  SolverRun& operator=(const SolverRun&) = delete;

  RadiositySystem system;
  const SolverOptions& options;
  const ExchangeGroups groups;

  /// Keeps all further passes of this method in the journal of the options, if there is one.
  void keep_passes(SolverMethod method);

  /// Initial B: M, or the given start. 0 in groups without light; M where nothing is reflected.
  LightVector start() const;

  /// Notes a sweep of `method` that left B with this residual. Returns false after the last sweep,
  /// whether or not the tolerance was reached (see outcome).
  bool should_continue(SolverMethod method, const LightVector& B, const LightVector& residual);

  Outcome outcome() const { return outcome_; }
  const std::vector<StepRecord>& history() const { return history_; }

 private:
  void find_ends();
  [[noreturn]] void refuse_endless(int patch, int lane) const;

  std::optional<KeptPasses> passes_{};
  LightVector error_per_residual_;  // groups x lanes; 0 without light
  Outcome outcome_ = Outcome::max_sweeps_reached;
  std::vector<StepRecord> history_{};
  // Bound on the relative error after the first sweep, over tolerance.
  double first_excess_ = 0.0;
  double share_ = 0.0;
  std::chrono::steady_clock::time_point begun_ = std::chrono::steady_clock::now();
};

}  // namespace lightwell
