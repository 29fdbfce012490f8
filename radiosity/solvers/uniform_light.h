#pragma once

#include "radiosity/solvers/solver_run.h"

namespace lightwell {

/// The part of the error that decays slowest in a bright room: the same irradiance everywhere, B =
/// rho. One unknown per group of patches that exchange light, and per band, is solved for directly:
/// a two-level correction (or, within conjugate gradients, deflation). Afterwards the residual of
/// each group adds up to nothing, sum_i A_i r_i = 0: no power is missing.
class UniformLight {
 public:
  /// One pass over the rows.
  explicit UniformLight(const SolverRun& run);

  /// B += alpha rho with the alpha that makes the power of `residual` 0, and the residual of that.
  /// Dark groups have no residual and so stay exactly dark.
  void correct(LightVector& residual, LightVector& B) const;

  /// What keeps it so along a direction of conjugate gradients: direction -= c rho, with the c that
  /// makes r - c rho conjugate to rho in the inner product with weights A / rho. What `direction`
  /// holds besides r has to be so already.
  void deflate(const LightVector& weight, const LightVector& r, LightVector& direction) const;

 private:
  template <class Values>
  LightVector sums(Values values) const;
  LightVector over_drain(const LightVector& sums) const;

  const SolverRun& run_;
  LightVector drained_;  // (I - rho F) rho
  LightVector drain_;    // power that uniform light loses: groups x lanes
};

}  // namespace lightwell
