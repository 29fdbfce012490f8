#pragma once

#include <functional>
#include <memory>
#include <string_view>
#include <vector>

#include "radiosity/form_factors/row_estimates.h"
#include "radiosity/journal/journal_phase.h"

namespace lightwell {

/// Exchange areas S_ij = A_i F_ij that closed forms give. They take the place of what the rows
/// estimate for those pairs.
struct KnownExchange {
  KnownExchange(std::shared_ptr<MemoryBudget> budget, int patches)
      : S(std::move(budget), patches), is_whole(static_cast<std::size_t>(patches), 0) {}

  RowStore<FormFactor> S;  ///< of pairs j > i, in row i, columns rising
  /// Per patch: 1 if they are all that the patch exchanges with any other, 0 if only some pairs.
  std::vector<char> is_whole;
};

/// The phase of a journal that has this name.
using PhaseOf = std::function<JournalPhase(std::string_view name)>;

/// Joins the two estimates of every pair, puts known exchange in its place, closes the rows if
/// asked (what was sampled first, then everything), and stores the result. What it is given is
/// given up piece by piece while the result grows. `phase_of` names where scalings keep their
/// states.
std::unique_ptr<FormFactors> assemble_form_factors(const PatchMesh& mesh, RowEstimates rows,
                                                   KnownExchange known, bool enforce_closure,
                                                   std::shared_ptr<MemoryBudget> budget,
                                                   const Progress& progress,
                                                   const PhaseOf& phase_of,
                                                   FormFactorReport* report);

}  // namespace lightwell
