// Stationary solvers: Jacobi, Gauss-Seidel, SOR (Cohen & Wallace 1993, section 5.3).
#include <algorithm>
#include <cmath>

#include "radiosity/solvers/solvers.h"
#include "radiosity/solvers/uniform_light.h"

namespace lightwell {
namespace {

// B_i += omega (M_i + rho_i sum_j F_ij B_j - B_i), one patch after another; with tau_i times the
// irradiance behind a translucent patch.
void sweep(const RadiositySystem& system, double omega, LightVector& B) {
  constexpr int rows_between_pauses = 4096;
  LaneArray E(system.lanes()), E_behind(system.lanes());
  for (int i = 0; i < system.patch_count(); ++i) {
    system.row(i, B, E.data());
    const int behind = system.behind(i);
    if (behind < 0) {
      B.row(i) += omega * (system.M.row(i) + system.rho.row(i) * E - B.row(i));
    } else {
      system.row(behind, B, E_behind.data());
      B.row(i) += omega * (system.M.row(i) + system.rho.row(i) * E + system.tau.row(i) * E_behind -
                           B.row(i));
    }
    if ((i + 1) % rows_between_pauses == 0) system.pause();
  }
}

// Young's omega = 2 / (1 + sqrt(1 - q)), where q is the factor of Gauss-Seidel's residual per
// sweep. The formula is optimal for consistently ordered matrices, which radiosity's are not, so
// its effect is monitored.
class Relaxation {
 public:
  explicit Relaxation(double given) : omega_(given > 0.0 ? given : 1.0), is_given_(given > 0.0) {}
  double omega() const { return omega_; }

  // Notes the residual's size after a sweep, and adapts omega.
  void see(double size) {
    const double rate = last_ > 0.0 ? size / last_ : 1.0;
    last_ = size;
    if (is_given_ || ++sweeps_ < sweeps_to_settle || !(size > 0.0)) return;
    sweeps_ = 0;
    if (omega_ == 1.0) {
      plain_rate_ = rate;
      omega_ = 2.0 / (1.0 + std::sqrt(1.0 - std::min(rate, 1.0)));
    } else if (rate > plain_rate_) {
      omega_ = 1.0 + 0.5 * (omega_ - 1.0);
    }
  }

 private:
  static constexpr int sweeps_to_settle = 3;
  double omega_ = 1.0, last_ = 0.0, plain_rate_ = 1.0;
  bool is_given_ = false;
  int sweeps_ = 0;
};

}  // namespace

LightVector solve_by_jacobi(SolverRun& run) {
  LightVector B = run.start(), r = run.system.residual(B);
  while (run.should_continue(SolverMethod::jacobi, B, r)) {
    B += r;
    r = run.system.residual(B);
  }
  return B;
}

LightVector solve_by_gauss_seidel(SolverRun& run) {
  const UniformLight uniform(run);
  LightVector B = run.start(), r;
  do {
    run.system.pass([&] { sweep(run.system, 1.0, B); }, B);
    r = run.system.residual(B);
    uniform.correct(r, B);
  } while (run.should_continue(SolverMethod::gauss_seidel, B, r));
  return B;
}

LightVector solve_by_sor(SolverRun& run) {
  Relaxation relaxation(run.options.relaxation);
  LightVector B = run.start(), r;
  do {
    run.system.pass([&] { sweep(run.system, relaxation.omega(), B); }, B);
    r = run.system.residual(B);
    relaxation.see(std::sqrt(weighted_dot(run.system.area, r, r).sum()));
  } while (run.should_continue(SolverMethod::sor, B, r));
  return B;
}

}  // namespace lightwell
