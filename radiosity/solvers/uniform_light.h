#pragma once

#include "radiosity/solvers/solver_run.h"

namespace lightwell {

/// Correction for the slowest part of the error in a bright room: the same irradiance everywhere, B
/// = rho + tau. One unknown per band and group of patches that exchange light is solved for
/// directly: a two-level correction or, within conjugate gradients, deflation. Afterwards the
/// residual of each group sums to zero, sum_i A_i r_i = 0: the power balances.
class UniformLight {
 public:
  /// Makes one pass over the rows.
  explicit UniformLight(const SolverRun& run);

  /// B += alpha (rho + tau), with the alpha for which the power of `residual` becomes 0, and
  /// updates `residual`. Groups without light have no residual and stay exactly 0.
  void correct(LightVector& residual, LightVector& B) const;

  /// Deflates a direction of conjugate gradients, which keeps the power of residuals at 0:
  /// direction -= c rho, with the c for which r - c rho is conjugate to rho in the inner product
  /// with weights A / rho. Precondition: nothing is translucent; the part of `direction` other than
  /// r is conjugate to rho.
  void deflate(const LightVector& weight, const LightVector& r, LightVector& direction) const;

 private:
  template <class Values>
  LightVector sums(Values values) const;
  LightVector over_drain(const LightVector& sums) const;

  const SolverRun& run_;
  LightVector drained_;  // (I - R F) (rho + tau)
  LightVector drain_;    // power lost by uniform light: groups x lanes
};

}  // namespace lightwell
