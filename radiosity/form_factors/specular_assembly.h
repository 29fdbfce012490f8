#pragma once

#include "radiosity/form_factors/form_factor_assembly.h"
#include "radiosity/form_factors/row_estimates.h"
#include "radiosity/form_factors/stored_form_factors.h"

namespace lightwell {

/// Joins both ends' estimates of the exchange through mirrors and glass, per band, and adds the
/// exchange and its losses to `result`. With options.enforce_closure the exchange of each band is
/// scaled symmetrically until every row keeps its light:
///
///     S_ij = n_i^2 A_i F^s_ij
///     sum_j S_ij (1 - s_j) / (n_i^2 A_i) + lost_i = c_i + sum_j F_ij s_j
///
/// n_i is the index of refraction around patch i (options.squared_index), s_j is the share that
/// patch j mirrors of what arrives there (options.mirrored), c_i the share of row i that first
/// meets a mirror or glass alone, and `entering` the sum on the right, patches x bands, of the F_ij
/// that are stored; empty where no patch both mirrors and diffuses. Rays measured the shares of the
/// left, in proportion.
void assemble_specular(const PatchMesh& mesh, RowEstimates& rows, const AssemblyOptions& options,
                       const Eigen::ArrayXXd& entering, StoredFormFactors& result);

}  // namespace lightwell
