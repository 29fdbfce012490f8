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

/// How B = M + rho F B is solved. All read the stored rows of F, extended form factors included,
/// with all bands in one pass, and keep the same promise of accuracy.
enum class SolverMethod {
  /// Conjugate gradients; BiCGSTAB where F turns out not to be reciprocal.
  automatic,
  /// Gathers to patch after patch (Cohen & Wallace 1993, section 5.3.2), then solves directly for
  /// uniform light, which converges slowest in a bright closed room.
  gauss_seidel,
  /// One more bounce of light a sweep, all patches at once (Cohen & Wallace 1993, section 5.3.1).
  jacobi,
  /// Gauss-Seidel with each step stretched (Young 1954; Cohen & Wallace 1993, section 5.3.4).
  sor,
  /// Largest residual first, by columns: what progressive refinement shoots (Gortler, Cohen &
  /// Slusallek 1994). Needs reciprocity.
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
/// What the methods are called wherever one is asked for by name.
inline constexpr std::array<NamedSolverMethod, 8> solver_methods = {
    {{"auto", SolverMethod::automatic},
     {"gauss-seidel", SolverMethod::gauss_seidel},
     {"jacobi", SolverMethod::jacobi},
     {"sor", SolverMethod::sor},
     {"southwell", SolverMethod::southwell},
     {"cg", SolverMethod::conjugate_gradients},
     {"bicgstab", SolverMethod::bicgstab},
     {"gmres", SolverMethod::gmres}}};

/// Throws std::invalid_argument, naming all that there are, for a name that is none of them.
SolverMethod solver_method(std::string_view name);
std::string_view solver_name(SolverMethod method);

/// What a solver has after a sweep.
struct SolverSweep {
  int number = 0;  ///< 1 for the first
  SolverMethod method = SolverMethod::automatic;
  const StepRecord& record;
  const BandArray& radiosity;  ///< B_i, W/m^2, patches x bands; record.residual is of this
};

struct SolverOptions {
  /// Ends when the bound on the relative error of B, |residual| / (1 - rho_max) over the largest B,
  /// falls below. rho_max is that of the patches that exchange light with the one whose residual it
  /// is, in that band; where it is 1 the relative residual itself has to be below.
  double tolerance = 1e-5;
  /// A fuse. Sweeps are passes over the rows, two for gauss-seidel, sor and southwell (the second
  /// one measures the residual).
  int max_sweeps = 500;
  double relaxation = 0.0;  ///< omega of sor, in (0, 2); 0: found on the way
  int gmres_restart = 20;   ///< vectors that gmres keeps, each of 8 bytes per patch and band
  /// B to start from, patches x bands: a result to go on with, or of other reflectances. Empty: M.
  BandArray start{};
  /// E0_i, W/m^2, patches x bands: light that arrives from elsewhere than other patches, such as
  /// from lamps (see FreeLight). What is solved is then B = M + rho (E0 + F B). Empty: none.
  BandArray arriving{};
  /// Sees every sweep, from the thread that called the solver.
  std::function<void(const SolverSweep&)> observer{};
  RunControl run{};  ///< the journal keeps passes over the rows once they take long
  /// What messages call a patch; empty: "patch 12".
  std::function<std::string(int patch)> name_of{};
};

/// E_i = sum_j F_ij B_j, extended form factors included: patches x bands, W/m^2.
BandArray gather(const FormFactors& form_factors, const BandArray& radiosity);

/// Solves B = M + rho F B. Fills patch_radiosity, solver, history, residual and outcome of the
/// result, the same bits for any number of threads. Patches that no light reaches get exactly 0,
/// whatever they reflect.
///
/// Throws InputError where light has no end (patches with emission among them that reflect all, and
/// nothing gets out) and where F is not as reciprocal as the method needs; std::invalid_argument if
/// a patch has no area, or an option is out of range; std::runtime_error rather than return what is
/// not finite; Interrupted when progress says stop.
RadiositySolution solve_radiosity(SolverMethod method, const PatchMesh& mesh,
                                  const FormFactors& form_factors,
                                  const SolverOptions& options = {});

}  // namespace lightwell
