#pragma once

#include "radiosity/form_factors.h"
#include "radiosity/solution.h"
#include "scene/progress.h"

namespace lightwell {

struct GaussSeidelOptions {
  /// Ends when the bound on the relative error of B, |residual| / (1 - rho_max) over the largest B,
  /// falls below (where rho_max < 1; else the relative residual itself).
  double tolerance = 1e-5;
  int max_sweeps = 500;  ///< a fuse
  Progress progress{};
};

/// E_i = sum_j F_ij B_j, extended form factors included: patches x bands, W/m^2.
BandArray gather(const FormFactors& form_factors, const BandArray& radiosity);

/// Solves B = M + rho F B by Gauss-Seidel sweeps over all bands at once (Cohen & Wallace 1993,
/// section 5.3.2). After each sweep the constant mode, which converges slowest in a bright closed
/// room, is solved for exactly (a two-level correction with one coarse unknown per band), so that
/// sweeps hardly depend on the reflectance. Fills patch_radiosity, history, residual and outcome of
/// the result. Throws std::invalid_argument if a patch has no area, std::runtime_error rather than
/// return what is not finite.
RadiositySolution solve_gauss_seidel(const PatchMesh& mesh, const FormFactors& form_factors,
                                     const GaussSeidelOptions& options = {});

}  // namespace lightwell
