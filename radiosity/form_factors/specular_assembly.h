#pragma once

#include "radiosity/form_factors/form_factor_assembly.h"
#include "radiosity/form_factors/row_estimates.h"
#include "radiosity/form_factors/stored_form_factors.h"

namespace lightwell {

/// Joins both ends' estimates of what goes by way of mirrors and glass, band by band, and adds that
/// and what is lost there to `result`. With `enforce_closure` each band's exchange is scaled
/// symmetrically until every row passes on what its own rays measured in all.
void assemble_specular(const PatchMesh& mesh, RowEstimates& rows, bool enforce_closure,
                       const std::shared_ptr<MemoryBudget>& budget, const PhaseOf& phase_of,
                       StoredFormFactors& result);

}  // namespace lightwell
