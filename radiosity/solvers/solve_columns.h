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

}  // namespace lightwell
