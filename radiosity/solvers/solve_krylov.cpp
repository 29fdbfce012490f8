// Krylov solvers: B lies in the span of repeated bounces of the first residual. Eigen's solvers
// take one right-hand side at a time, so each of K bands, whose matrices differ by reflectance and
// tint, would read all rows separately. Here every band has its own scalars, and all bands share a
// pass.
#include <Eigen/QR>
#include <cmath>
#include <vector>

#include "radiosity/solvers/solvers.h"
#include "radiosity/solvers/uniform_light.h"

namespace lightwell {
namespace {

// a / b per band; 0 for b = 0, so that solved and dark bands (0 / 0) stay unchanged.
LaneArray quotient(const LaneArray& a, const LaneArray& b) {
  return (b != 0.0).select(a / b, 0.0);
}

// y += a x, per band.
void add(LightVector& y, const LaneArray& a, const LightVector& x) {
  for (Eigen::Index i = 0; i < y.rows(); ++i) y.row(i) += a * x.row(i);
}

// y = x + a y.
void scale_and_add(LightVector& y, const LaneArray& a, const LightVector& x) {
  for (Eigen::Index i = 0; i < y.rows(); ++i) y.row(i) = x.row(i) + a * y.row(i);
}

}  // namespace

// In the inner product sum_i (A_i / rho_i) a_i b_i the matrix I - rho F is symmetric, because A_i
// F_ij is, and positive definite. Conjugate gradients in that inner product equal those on (A /
// rho) B - A F B, preconditioned by the diagonal A / rho. Where rho_i = 0, B_i = M_i from the
// start, and residuals and directions are 0 throughout. Uniform light is deflated (Saad, Yeung,
// Erhel & Guyomarc'h 2000), which costs a pass and saves a few, and balances the power of every
// iterate.
LightVector solve_by_conjugate_gradients(SolverRun& run) {
  const RadiositySystem& system = run.system;
  LightVector weight = (system.rho > 0.0).select(1.0 / system.rho, 0.0);
  weight.colwise() *= system.area;
  const UniformLight uniform(run);
  LightVector B = run.start(), r = system.residual(B);
  uniform.correct(r, B);
  while (run.should_continue(SolverMethod::conjugate_gradients, B, r)) {
    LightVector p = r;
    uniform.deflate(weight, r, p);
    LaneArray rr = weighted_dot(weight, r, r), least = rr;
    bool should_continue = true, is_astray = false;
    while (should_continue && !is_astray) {
      const LightVector q = system.product(p);
      const LaneArray alpha = quotient(rr, weighted_dot(weight, p, q));
      add(B, alpha, p);
      add(r, -alpha, q);
      const LaneArray before = rr;
      rr = weighted_dot(weight, r, r);
      scale_and_add(p, quotient(rr, before), r);
      uniform.deflate(weight, r, p);
      // With a tolerance below rounding, directions become meaningless, and B of a band would
      // diverge.
      constexpr double grown = 1e4;
      least = least.min(rr);
      is_astray = (rr > grown * least).any();
      should_continue = run.should_continue(SolverMethod::conjugate_gradients, B, r);
    }
    if (!should_continue && run.outcome() != Outcome::converged) break;
    r = system.residual(B);  // the recurrence for r accumulates rounding
    uniform.correct(r, B);
  }
  return B;
}

LightVector solve_by_bicgstab(SolverRun& run) {
  const RadiositySystem& system = run.system;
  const auto dot = [&](const LightVector& a, const LightVector& b) {
    return weighted_dot(system.area, a, b);
  };
  LightVector B = run.start(), r = system.residual(B);
  while (run.should_continue(SolverMethod::bicgstab, B, r)) {
    const LightVector shadow = r;
    LightVector p = r;
    LaneArray rho = dot(shadow, r);
    const LaneArray first = rho;
    bool should_continue = true, is_stuck = false;
    while (should_continue && !is_stuck) {
      const LightVector v = system.product(p);
      const LaneArray alpha = quotient(rho, dot(shadow, v));
      add(B, alpha, p);
      add(r, -alpha, v);
      should_continue = run.should_continue(SolverMethod::bicgstab, B, r);
      if (!should_continue) break;
      const LightVector t = system.product(r);
      const LaneArray omega = quotient(dot(t, r), dot(t, t));
      add(B, omega, r);
      add(p, -omega, v);
      add(r, -omega, t);
      should_continue = run.should_continue(SolverMethod::bicgstab, B, r);
      const LaneArray next = dot(shadow, r);
      scale_and_add(p, quotient(next, rho) * quotient(alpha, omega), r);
      // The method breaks down once the residual is orthogonal to the first residual.
      constexpr double right_angle = 1e-14;
      is_stuck = (next.square() < right_angle * right_angle * first * dot(r, r)).any();
      rho = next;
    }
    if (run.outcome() != Outcome::converged && !is_stuck) break;
    r = system.residual(B);
  }
  return B;
}

namespace {

// Least-squares solution y of H y = first e_1.
Eigen::VectorXd shortest_residual(const Eigen::MatrixXd& H, double first) {
  Eigen::VectorXd rhs = Eigen::VectorXd::Zero(H.rows());
  rhs[0] = first;
  return H.colPivHouseholderQr().solve(rhs);
}

}  // namespace

LightVector solve_by_gmres(SolverRun& run) {
  const RadiositySystem& system = run.system;
  const int most = run.options.gmres_restart, lanes = system.lanes();
  const auto size = [&](const LightVector& x) -> LaneArray {
    return weighted_dot(system.area, x, x).sqrt();
  };
  LightVector B = run.start(), r = system.residual(B);
  while (run.should_continue(SolverMethod::gmres, B, r)) {
    // Arnoldi: A V_m = V_m+1 H, with one H per band.
    std::vector<Eigen::MatrixXd> H(static_cast<std::size_t>(lanes),
                                   Eigen::MatrixXd::Zero(most + 1, most));
    const LaneArray first = size(r);
    std::vector<LightVector> V{LightVector::Zero(r.rows(), r.cols())};
    add(V[0], quotient(LaneArray::Ones(lanes), first), r);
    LightVector better, left;
    bool should_continue = true;
    for (int m = 0; m < most && should_continue; ++m) {
      LightVector w = system.product(V[m]);
      for (int i = 0; i <= m; ++i) {
        const LaneArray h = weighted_dot(system.area, w, V[i]);
        add(w, -h, V[i]);
        for (int k = 0; k < lanes; ++k) H[k](i, m) = h[k];
      }
      const LaneArray length = size(w);
      for (int k = 0; k < lanes; ++k) H[k](m + 1, m) = length[k];
      V.emplace_back(LightVector::Zero(w.rows(), w.cols()));
      add(V.back(), quotient(LaneArray::Ones(lanes), length), w);

      Eigen::ArrayXXd y(m + 1, lanes), Hy(m + 2, lanes);
      for (int k = 0; k < lanes; ++k) {
        const Eigen::MatrixXd H_m = H[k].topLeftCorner(m + 2, m + 1);
        y.col(k) = shortest_residual(H_m, first[k]).array();
        Hy.col(k) = (H_m * y.col(k).matrix()).array();
      }
      better = B;
      left = r;
      for (int i = 0; i <= m; ++i) add(better, y.row(i), V[i]);
      for (int i = 0; i <= m + 1; ++i) add(left, -Hy.row(i), V[i]);
      should_continue = run.should_continue(SolverMethod::gmres, better, left);
    }
    B = better;
    if (!should_continue && run.outcome() != Outcome::converged) break;
    r = system.residual(B);
  }
  return B;
}

}  // namespace lightwell
