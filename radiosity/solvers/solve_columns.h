#pragma once

#include "radiosity/solvers/solve_radiosity.h"

namespace lightwell {

/// Solves B = rho (E0 + F B) for many right-hand sides at once: the patches of `mesh` without their
/// emission. `arriving` is E0, patches x columns, W/m^2; a column has all bands of `mesh`, one
/// behind the other. Returns B in the same columns, W/m^2. The error of each column is at most
/// `tolerance` / (1 - rho_max) of its largest B (see SolverOptions).
///
/// Columns are solved in blocks, since a pass over the rows takes as long for one as for several.
/// Throws what solve_radiosity() throws, and std::runtime_error if a solve does not converge.
BandArray solve_columns(const PatchMesh& mesh, const FormFactors& form_factors,
                        const BandArray& arriving, double tolerance, const Progress& progress = {});

/// Importance of patches (Smits, Arvo & Salesin 1992): the weights w of arriving light in what a
/// receiver gets of the radiosity that this light causes,
///
///     sum_p g_p B_p = sum_p w_p E0_p    for every E0, where B = rho (E0 + F B).
///
/// `received` is g, patches x columns, a receiver's bands in a column each; the result is w in the
/// same columns. By reciprocity, A_i F_ij = A_j F_ji, importance is light that receivers send:
///
///     w = A B',   B' = rho (g / A + F B').
///
/// `tolerance` and what is thrown are those of solve_columns(), for B'.
BandArray solve_importance(const PatchMesh& mesh, const FormFactors& form_factors,
                           BandArray received, double tolerance, const Progress& progress = {});

}  // namespace lightwell
