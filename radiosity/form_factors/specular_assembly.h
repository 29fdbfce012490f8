#pragma once

#include "radiosity/form_factors/form_factor_assembly.h"
#include "radiosity/form_factors/row_estimates.h"
#include "radiosity/form_factors/stored_form_factors.h"

namespace lightwell {

/// Joins both ends' estimates of the exchange through mirrors and glass, per band, and adds the
/// exchange and its losses to `result`. With options.enforce_closure the exchange of each band is
/// scaled symmetrically until every row passes on the share that its own rays measured.
void assemble_specular(const PatchMesh& mesh, RowEstimates& rows, const AssemblyOptions& options,
                       StoredFormFactors& result);

}  // namespace lightwell
