#include <algorithm>
#include <bit>
#include <cmath>
#include <vector>

#include "radiosity/solvers/solvers.h"

namespace lightwell {
namespace {

// Largest of n changing values: a tournament tree, leaves last.
class Largest {
 public:
  explicit Largest(int n) : leaves_(std::bit_ceil(static_cast<unsigned>(std::max(n, 1)))) {
    values_.assign(2 * leaves_, 0.0);
  }
  void set(int i, double value) {
    std::size_t at = leaves_ + static_cast<std::size_t>(i);
    values_[at] = value;
    while (at > 1) {
      at /= 2;
      const double winner = std::max(values_[2 * at], values_[2 * at + 1]);
      if (winner == values_[at]) return;  // unchanged from here up
      values_[at] = winner;
    }
  }
  double value() const { return values_[1]; }
  int index() const {
    std::size_t at = 1;
    while (at < leaves_) at = 2 * at + (values_[2 * at] == values_[at] ? 0 : 1);
    return static_cast<int>(at - leaves_);
  }

 private:
  std::size_t leaves_;
  std::vector<double> values_;
};

class SouthwellShooter {
 public:
  SouthwellShooter(const RadiositySystem& system, LightVector& B, LightVector& r)
      : system_(system),
        B_(B),
        r_(r),
        lanes_(system.lanes()),
        rho_per_area_(system.rho.colwise() / system.area),
        unshot_(system.patch_count()) {
    if (system.is_translucent()) tau_per_area_ = system.tau.colwise() / system.area;
  }

  // Shoots until `factors` entries of F are read.
  void shoot_for(std::size_t factors) {
    for (int i = 0; i < system_.patch_count(); ++i) unshot_.set(i, unshot_power(i));
    constexpr int shots_between_pauses = 1024;
    int shots = 0;
    for (std::size_t read = 0; read < factors && unshot_.value() > 0.0;) {
      read += shoot(unshot_.index()) + 1;
      if (++shots % shots_between_pauses == 0) system_.pause();
    }
  }

 private:
  // A_i |r_i|, summed over bands.
  double unshot_power(int i) const { return system_.area[i] * r_.row(i).abs().sum(); }

  // B_i += r_i, and r_j += rho_j F_ji r_i, with column i of F taken from row i by reciprocity, F_ji
  // = A_i F_ij / A_j; behind a translucent patch j, r += tau F_ji r_i. Returns the number of
  // entries read.
  std::size_t shoot(int i) {
    power_ = system_.area[i] * r_.row(i);
    B_.row(i) += r_.row(i);
    r_.row(i).setZero();
    unshot_.set(i, 0.0);
    const std::span<const FormFactor> row = system_.form_factors().row(i);
    for (const auto [j, F] : row) {
      receive(j, [F = static_cast<double>(F)](int) { return F; });
    }
    const SpecularRow specular = system_.form_factors().specular_row(i);
    for (std::size_t s = 0; s < specular.patch.size(); ++s) {
      const auto F = specular.value.row(static_cast<Eigen::Index>(s));
      receive(specular.patch[s],
              [&](int k) { return k < system_.bands() ? static_cast<double>(F[k]) : 0.0; });
    }
    return row.size() + specular.patch.size();
  }

  template <class Factor>
  void receive(int j, Factor F) {
    scatter(j, &rho_per_area_(j, 0), F);
    // Both sides of a sheet have the same area.
    if (const int behind = system_.behind(j); behind >= 0) {
      scatter(behind, &tau_per_area_(behind, 0), F);
    }
  }

  template <class Factor>
  void scatter(int j, const double* share_per_area, Factor F) {
    double* const r = &r_(j, 0);
    double sum = 0.0;
    for (int k = 0; k < lanes_; ++k) {
      r[k] += share_per_area[k] * F(k) * power_[k];
      sum += std::abs(r[k]);
    }
    unshot_.set(j, system_.area[j] * sum);
  }

  const RadiositySystem& system_;
  LightVector &B_, &r_;
  int lanes_ = 0;
  LightVector rho_per_area_, tau_per_area_;
  Largest unshot_;
  LaneArray power_;
};

std::size_t count_factors(const FormFactors& form_factors) {
  std::size_t count = 0;
  for (int i = 0; i < form_factors.patch_count(); ++i) {
    count += form_factors.row(i).size() + form_factors.specular_row(i).patch.size();
  }
  return count;
}

}  // namespace

LightVector solve_by_southwell(SolverRun& run) {
  const std::size_t factors = count_factors(run.system.form_factors());
  LightVector B = run.start(), r = run.system.residual(B);
  SouthwellShooter shooter(run.system, B, r);
  while (run.should_continue(SolverMethod::southwell, B, r)) {
    run.system.pass([&] { shooter.shoot_for(factors); }, B, r);
    r = run.system.residual(B);  // reciprocity holds up to rounding
  }
  return B;
}

}  // namespace lightwell
