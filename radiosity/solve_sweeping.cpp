// The solvers that go from patch to patch: Jacobi, Gauss-Seidel, SOR.
#include <algorithm>
#include <cmath>

#include "radiosity/solvers.h"

namespace lightwell {
namespace {

// B_i += omega (M_i + rho_i sum_j F_ij B_j - B_i), patch after patch.
void sweep(const RadiositySystem& system, double omega, LightVector& B) {
  constexpr int rows_between_pauses = 4096;
  LaneArray E(system.lanes());
  for (int i = 0; i < system.patch_count(); ++i) {
    system.row(i, B, E.data());
    B.row(i) += omega * (system.M.row(i) + system.rho.row(i) * E - B.row(i));
    if ((i + 1) % rows_between_pauses == 0) system.pause();
  }
}

// alpha per group of exchanging patches and band with sum_i A_i (residual of B + alpha v)_i = 0,
// where v = 1 wherever light is reflected: a two-level correction with one coarse unknown each. A
// dark room has no residual and so stays exactly dark.
class ConstantMode {
 public:
  explicit ConstantMode(const SolverRun& run)
      : run_(run),
        shape_((run.system.rho > 0.0).cast<double>()),
        drained_(run.system.product(shape_)),
        drain_(sums(drained_)) {}

  void correct(LightVector& residual, LightVector& B) const {
    const double least_drain = 1e-9 * run_.system.area.sum();
    const LightVector alpha = (drain_ > least_drain).select(sums(residual) / drain_, 0.0);
    for (Eigen::Index i = 0; i < B.rows(); ++i) {
      const int g = run_.groups.group_of[i];
      B.row(i) += alpha.row(g) * shape_.row(i);
      residual.row(i) -= alpha.row(g) * drained_.row(i);
    }
  }

 private:
  // sum_i A_i values_i over each group.
  LightVector sums(const LightVector& values) const {
    LightVector sum = LightVector::Zero(run_.groups.count, values.cols());
    for (Eigen::Index i = 0; i < values.rows(); ++i) {
      sum.row(run_.groups.group_of[i]) += run_.system.area[i] * values.row(i);
    }
    return sum;
  }

  const SolverRun& run_;
  LightVector shape_, drained_, drain_;
};

// Young's omega = 2 / (1 + sqrt(1 - q)), for Gauss-Seidel whose residual falls by q a sweep. It is
// the best one for matrices that radiosity's are not, so what it does is watched.
class Relaxation {
 public:
  explicit Relaxation(double given) : omega_(given > 0.0 ? given : 1.0), is_given_(given > 0.0) {}
  double omega() const { return omega_; }

  // After a sweep that left a residual of this size.
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
  while (run.goes_on(SolverMethod::jacobi, B, r)) {
    B += r;
    r = run.system.residual(B);
  }
  return B;
}

LightVector solve_by_gauss_seidel(SolverRun& run) {
  const ConstantMode constant_mode(run);
  LightVector B = run.start(), r;
  do {
    sweep(run.system, 1.0, B);
    r = run.system.residual(B);
    constant_mode.correct(r, B);
  } while (run.goes_on(SolverMethod::gauss_seidel, B, r));
  return B;
}

LightVector solve_by_sor(SolverRun& run) {
  Relaxation relaxation(run.options.relaxation);
  LightVector B = run.start(), r;
  do {
    sweep(run.system, relaxation.omega(), B);
    r = run.system.residual(B);
    relaxation.see(std::sqrt(weighted_dot(run.system.area, r, r).sum()));
  } while (run.goes_on(SolverMethod::sor, B, r));
  return B;
}

}  // namespace lightwell
