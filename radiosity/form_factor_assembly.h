#pragma once

#include <memory>
#include <vector>

#include "radiosity/balance.h"
#include "radiosity/estimated_row.h"

namespace lightwell {

/// Exchange areas S_ij = A_i F_ij that closed forms give, symmetric. They take the place of what
/// the rows estimate for those pairs.
struct KnownExchange {
  std::vector<SymmetricEntry> S{};
  /// Per patch: 1 if they are all that the patch exchanges with any other, 0 if only some pairs.
  std::vector<char> is_whole{};
};

/// Joins the two estimates of every pair, puts known exchange in its place, closes the rows if
/// asked (what was sampled first, then everything), and stores the result.
std::unique_ptr<FormFactors> assemble_form_factors(const PatchMesh& mesh, int bands,
                                                   std::vector<EstimatedRow> rows,
                                                   const KnownExchange& known, bool enforce_closure,
                                                   FormFactorReport* report);

}  // namespace lightwell
