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
};

/// Phase of a journal by name.
using PhaseOf = std::function<JournalPhase(std::string_view name)>;

/// Joins the two estimates of every pair, replaces pairs by known exchange, and stores the result.
/// With `enforce_closure` rows are closed by scaling: sampled exchange first, then all exchange.
/// `rows` and `known` are released piece by piece while the result grows. `phase_of` gives the
/// phases that keep the states of the scalings.
std::unique_ptr<FormFactors> assemble_form_factors(const PatchMesh& mesh, RowEstimates rows,
                                                   KnownExchange known, bool enforce_closure,
                                                   std::shared_ptr<MemoryBudget> budget,
                                                   const Progress& progress,
                                                   const PhaseOf& phase_of,
                                                   FormFactorReport* report);

}  // namespace lightwell
