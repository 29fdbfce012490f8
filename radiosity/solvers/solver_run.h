#pragma once

#include <chrono>
#include <optional>

#include "radiosity/solvers/exchange_groups.h"
#include "radiosity/solvers/radiosity_system.h"
#include "radiosity/solvers/solve_radiosity.h"

namespace lightwell {

/// What all solvers share: where they start, when they may stop, and what is noted on the way.
class SolverRun {
 public:
  /// Throws as solve_radiosity does for wrong input.
  SolverRun(const PatchMesh& mesh, const FormFactors& form_factors, const SolverOptions& options);
  SolverRun(const SolverRun&) = delete;
  SolverRun& operator=(const SolverRun&) = delete;

  RadiositySystem system;
  const SolverOptions& options;
  const ExchangeGroups groups;

  /// From now on passes of this method are kept in the journal of the options, if there is one.
  void keep_passes(SolverMethod method);

  /// B to start from: M, or the start given, where light is at all; M where nothing is reflected.
  LightVector start() const;

  /// Notes a sweep of `method` that left B with this residual. False when it was the last one, with
  /// the tolerance reached or not (see outcome).
  bool should_continue(SolverMethod method, const LightVector& B, const LightVector& residual);

  Outcome outcome() const { return outcome_; }
  const std::vector<StepRecord>& history() const { return history_; }

 private:
  void find_ends();
  [[noreturn]] void refuse_endless(int patch, int lane) const;

  std::optional<KeptPasses> passes_{};
  LightVector error_per_residual_;  // groups x lanes; 0 where there is no light
  Outcome outcome_ = Outcome::max_sweeps_reached;
  std::vector<StepRecord> history_{};
  double first_excess_ = 0.0;  // bound on the relative error after the first sweep, over tolerance
  double share_ = 0.0;
  std::chrono::steady_clock::time_point begun_ = std::chrono::steady_clock::now();
};

}  // namespace lightwell
