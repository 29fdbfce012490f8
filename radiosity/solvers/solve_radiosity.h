#pragma once

#include <array>
#include <functional>
#include <string>
#include <string_view>

#include "radiosity/form_factors/form_factors.h"
#include "radiosity/journal/run_control.h"
#include "radiosity/solution/solution.h"
#include "scene/progress.h"

namespace lightwell {

/// Solvers for B = M + rho F B. All read the stored rows of F, extended form factors included, with
/// all bands in one pass, and guarantee the same accuracy.
enum class SolverMethod {
  /// Conjugate gradients; BiCGSTAB where F turns out not to be reciprocal.
  automatic,
  /// Gathers to one patch after another (Cohen & Wallace 1993, section 5.3.2), then solves directly
  /// for uniform light, which converges slowest in a bright closed room.
  gauss_seidel,
  /// One more bounce of light per sweep, all patches at once (Cohen & Wallace 1993, section 5.3.1).
  jacobi,
  /// Gauss-Seidel with overrelaxation (Young 1954; Cohen & Wallace 1993, section 5.3.4).
  sor,
  /// Southwell relaxation, largest residual first, by columns: the iteration of progressive
  /// refinement (Gortler, Cohen & Slusallek 1994). Needs reciprocity.
  southwell,
  /// Conjugate gradients (Hestenes & Stiefel 1952) on (A / rho) B - A F B = (A / rho) M, which is
  /// symmetric and positive definite. Needs reciprocity.
  conjugate_gradients,
  bicgstab,  ///< van der Vorst 1992
  gmres      ///< Saad & Schultz 1986, restarted
};

struct NamedSolverMethod {
  std::string_view name;
  SolverMethod method;
};
/// Names of the methods in options and files.
inline constexpr std::array<NamedSolverMethod, 8> solver_methods = {
    {{"auto", SolverMethod::automatic},
     {"gauss-seidel", SolverMethod::gauss_seidel},
     {"jacobi", SolverMethod::jacobi},
     {"sor", SolverMethod::sor},
     {"southwell", SolverMethod::southwell},
     {"cg", SolverMethod::conjugate_gradients},
     {"bicgstab", SolverMethod::bicgstab},
     {"gmres", SolverMethod::gmres}}};

/// The method of that name. Throws std::invalid_argument that lists all names for any other name.
SolverMethod solver_method(std::string_view name);
std::string_view solver_name(SolverMethod method);

/// State of a solver after a sweep.
struct SolverSweep {
  int number = 0;  ///< 1 for the first
  SolverMethod method = SolverMethod::automatic;
  const StepRecord& record;
  /// B_i, W/m^2, patches x bands, of which record.residual is the residual.
  const BandArray& radiosity;
};

struct SolverOptions {
  /// Bound on the relative error of B, |residual| / (1 - rho_max) over the largest B, below which
  /// the solver ends. rho_max is the largest reflectance, per band, of the group of patches that
  /// exchange light with the patch of that residual. Where rho_max is 1, the relative residual
  /// itself is compared.
  double tolerance = 1e-5;
  /// Upper limit of sweeps. A sweep is a pass over the rows, or two passes in gauss-seidel, sor and
  /// southwell (the second measures the residual).
  int max_sweeps = 500;
  double relaxation = 0.0;  ///< omega of sor, in (0, 2); 0: adapted during the solve
  int gmres_restart = 20;   ///< vectors that gmres keeps, each of 8 bytes per patch and band
  /// Initial B, patches x bands: an earlier result, or a result for other reflectances. Empty: M.
  BandArray start{};
  /// E0_i, W/m^2, patches x bands: irradiance from other sources than patches, such as lamps (see
  /// FreeLight). The solved system is then B = M + rho (E0 + F B). Empty: none.
  BandArray arriving{};
  /// Called after every sweep, on the thread that called the solver.
  std::function<void(const SolverSweep&)> observer{};
  RunControl run{};  ///< the journal keeps passes over the rows once they take long
  /// Name of a patch in messages; empty: "patch 12".
  std::function<std::string(int patch)> name_of{};
};

/// E_i = n_i^2 sum_j F_ij B_j / n_j^2, extended form factors included, with the indices of
/// refraction of FormFactors::squared_index: patches x bands, W/m^2.
BandArray gather(const FormFactors& form_factors, const BandArray& radiosity);

/// Solves B = M + rho F B. Fills patch_radiosity, solver, history, residual and outcome of the
/// result, with the same bits for any number of threads. Patches that no light reaches get exactly
/// 0, whatever their reflectance.
///
/// Throws
///   - InputError if light is never absorbed: a group of patches that exchange light has emission,
///     all reflect everything, and nothing escapes;
///   - InputError if F is not as reciprocal as the method needs;
///   - std::invalid_argument if a patch has no area, or an option is out of range;
///   - std::runtime_error if B is not finite;
///   - Interrupted if `progress` requests a stop.
RadiositySolution solve_radiosity(SolverMethod method, const PatchMesh& mesh,
                                  const FormFactors& form_factors,
                                  const SolverOptions& options = {});

}  // namespace lightwell
