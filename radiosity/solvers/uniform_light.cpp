#include "radiosity/solvers/uniform_light.h"

namespace lightwell {

UniformLight::UniformLight(const SolverRun& run)
    : run_(run), drained_(run.system.product(run.system.albedo)) {
  drain_ = sums([&](Eigen::Index i) { return run_.system.area[i] * drained_.row(i); });
}

// Sums of values(i) over each group.
template <class Values>
LightVector UniformLight::sums(Values values) const {
  LightVector sum = LightVector::Zero(run_.groups.count, run_.system.lanes());
  for (Eigen::Index i = 0; i < run_.system.area.size(); ++i) {
    sum.row(run_.groups.group_of[i]) += values(i);
  }
  return sum;
}

LightVector UniformLight::over_drain(const LightVector& sums) const {
  const double least_drain = 1e-9 * run_.system.area.sum();
  return (drain_ > least_drain).select(sums / drain_, 0.0);
}

void UniformLight::correct(LightVector& residual, LightVector& B) const {
  const LightVector alpha =
      over_drain(sums([&](Eigen::Index i) { return run_.system.area[i] * residual.row(i); }));
  for (Eigen::Index i = 0; i < B.rows(); ++i) {
    const int g = run_.groups.group_of[i];
    B.row(i) += alpha.row(g) * run_.system.albedo.row(i);
    residual.row(i) -= alpha.row(g) * drained_.row(i);
  }
}

void UniformLight::deflate(const LightVector& weight, const LightVector& r,
                           LightVector& direction) const {
  const LightVector c =
      over_drain(sums([&](Eigen::Index i) { return weight.row(i) * drained_.row(i) * r.row(i); }));
  for (Eigen::Index i = 0; i < direction.rows(); ++i) {
    direction.row(i) -= c.row(run_.groups.group_of[i]) * run_.system.rho.row(i);
  }
}

}  // namespace lightwell
