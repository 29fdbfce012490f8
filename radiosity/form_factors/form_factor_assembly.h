#pragma once

#include <functional>
#include <memory>
#include <string_view>
#include <vector>

#include "radiosity/form_factors/row_estimates.h"
#include "radiosity/journal/journal_phase.h"

namespace lightwell {

/// Exchange areas S_ij = A_i F_ij from closed forms, which replace the rows' estimates of those
/// pairs.
struct KnownExchange {
  KnownExchange(std::shared_ptr<MemoryBudget> budget, int patches)
      : S(std::move(budget), patches), is_whole(static_cast<std::size_t>(patches), 0) {}

  RowStore<FormFactor> S;  ///< pairs j > i in row i, in ascending order of j
  /// Per patch: 1 if S holds all exchange of the patch, 0 if only some pairs.
  std::vector<char> is_whole;
  /// Per patch: sum of the errors of its F_ij in S; empty: unknown.
  std::vector<float> error{};
};

/// Phase of a journal by name.
using PhaseOf = std::function<JournalPhase(std::string_view name)>;

struct AssemblyOptions {
  bool enforce_closure = true;             ///< close rows by scaling
  std::shared_ptr<MemoryBudget> budget{};  ///< storage of the result
  Progress progress{};
  PhaseOf phase_of{};  ///< phases that keep the states of the scalings
  /// Shares of even light, [0,1], that patches mirror or pass straight on besides what they
  /// diffuse, patches x bands; empty: no patch does both.
  BandArray mirrored{};
  Eigen::ArrayXd squared_index{};  ///< of the result, see FormFactors
};

/// Joins the two estimates of every pair, replaces pairs by known exchange, closes the rows
/// (sampled exchange first, then all exchange), and stores the result. `rows` and `known` are
/// released piece by piece while the result grows.
std::unique_ptr<FormFactors> assemble_form_factors(const PatchMesh& mesh, RowEstimates rows,
                                                   KnownExchange known,
                                                   const AssemblyOptions& options,
                                                   FormFactorReport* report);

}  // namespace lightwell
