#include "radiosity/solve_gauss_seidel.h"

#include <fmt/format.h>

#include <chrono>
#include <cmath>
#include <numeric>
#include <stdexcept>
#include <vector>

#include "scene/parallel.h"

namespace lightwell {
namespace {

// sum_j F_ij B_j; Bands is a compile-time count where it is small, so that the sum stays in
// registers.
template <int Bands>
void gather_row(const FormFactors& form_factors, const BandArray& B, int i,
                Eigen::Array<double, 1, Bands>& E) {
  E.setZero(B.cols());
  for (const auto [j, F] : form_factors.row(i)) {
    E += static_cast<double>(F) * B.row(j).template cast<double>();
  }
  const SpecularRow specular = form_factors.specular_row(i);
  for (std::size_t s = 0; s < specular.patch.size(); ++s) {
    E += (specular.value.row(static_cast<Eigen::Index>(s)) * B.row(specular.patch[s]))
             .template cast<double>();
  }
}

template <int Bands>
void sweep(const PatchMesh& mesh, const FormFactors& form_factors, BandArray& B) {
  Eigen::Array<double, 1, Bands> E(B.cols());
  for (int i = 0; i < mesh.patch_count(); ++i) {
    gather_row<Bands>(form_factors, B, i, E);
    B.row(i) = mesh.emission.row(i) + mesh.reflectance.row(i) * E.template cast<float>();
  }
}

// Which patches exchange light with each other at all, directly or not: rooms without a door stay
// apart.
std::vector<int> exchanging_groups(const FormFactors& form_factors) {
  std::vector<int> parent(form_factors.patch_count());
  std::iota(parent.begin(), parent.end(), 0);
  const auto root = [&](int i) {
    while (parent[i] != i) i = parent[i] = parent[parent[i]];
    return i;
  };
  const auto join = [&](int i, int j) {
    const int a = root(i), b = root(j);
    parent[std::max(a, b)] = std::min(a, b);
  };
  for (int i = 0; i < form_factors.patch_count(); ++i) {
    for (const FormFactor& f : form_factors.row(i)) join(i, f.patch);
    for (const int j : form_factors.specular_row(i).patch) join(i, j);
  }
  std::vector<int> group(parent.size());
  for (std::size_t i = 0; i < group.size(); ++i) group[i] = root(static_cast<int>(i));
  return group;
}

// alpha per group of exchanging patches and band with sum_i A_i (residual of B + alpha v)_i = 0,
// where v = 1 wherever light is reflected. A dark room has no residual and so stays exactly dark.
class ConstantMode {
 public:
  ConstantMode(const PatchMesh& mesh, const FormFactors& form_factors)
      : group_(exchanging_groups(form_factors)),
        shape_((mesh.reflectance > 0.0f).cast<float>()),
        drain_(sums(mesh, shape_ - mesh.reflectance * gather(form_factors, shape_))) {}

  void correct(const PatchMesh& mesh, const BandArray& residual, BandArray& B) const {
    const Eigen::ArrayXXd alpha = sums(mesh, residual) / drain_;
    // A nearly lossless room has nothing to divide by; the sweeps then converge alone.
    const double least_drain = 1e-9 * mesh.area.sum();
    for (Eigen::Index i = 0; i < B.rows(); ++i) {
      const int g = group_[i];
      for (Eigen::Index k = 0; k < B.cols(); ++k) {
        if (drain_(g, k) > least_drain) B(i, k) += static_cast<float>(alpha(g, k)) * shape_(i, k);
      }
    }
  }

 private:
  // sum_i A_i values_i over each group; rows are numbered by a group's first patch.
  Eigen::ArrayXXd sums(const PatchMesh& mesh, const BandArray& values) const {
    Eigen::ArrayXXd sum = Eigen::ArrayXXd::Zero(values.rows(), values.cols());
    for (Eigen::Index i = 0; i < values.rows(); ++i) {
      sum.row(group_[i]) += mesh.area[i] * values.row(i).cast<double>();
    }
    return sum;
  }

  std::vector<int> group_;
  BandArray shape_;
  Eigen::ArrayXXd drain_;
};

}  // namespace

BandArray gather(const FormFactors& form_factors, const BandArray& radiosity) {
  BandArray E(radiosity.rows(), radiosity.cols());
  parallel_for(static_cast<int>(radiosity.rows()), 64, [&](int begin, int end) {
    Eigen::Array<double, 1, Eigen::Dynamic> sum(radiosity.cols());
    Eigen::Array<double, 1, 3> rgb_sum;
    for (int i = begin; i < end; ++i) {
      if (radiosity.cols() == 3) {
        gather_row<3>(form_factors, radiosity, i, rgb_sum);
        E.row(i) = rgb_sum.cast<float>();
      } else {
        gather_row<Eigen::Dynamic>(form_factors, radiosity, i, sum);
        E.row(i) = sum.cast<float>();
      }
    }
  });
  return E;
}

RadiositySolution solve_gauss_seidel(const PatchMesh& mesh, const FormFactors& form_factors,
                                     const GaussSeidelOptions& options) {
  for (int i = 0; i < mesh.patch_count(); ++i) {
    if (!(mesh.area[i] > 0.0)) {
      throw std::invalid_argument(fmt::format("patch {} has area {}", i, mesh.area[i]));
    }
  }
  const auto start = std::chrono::steady_clock::now();
  const double rho_max = mesh.reflectance.size() > 0 ? mesh.reflectance.maxCoeff() : 0.0;
  const double error_per_residual = rho_max < 1.0 ? 1.0 / (1.0 - rho_max) : 1.0;
  const ConstantMode constant_mode(mesh, form_factors);

  RadiositySolution solution;
  BandArray& B = solution.patch_radiosity;
  B = mesh.emission;
  solution.outcome = Outcome::max_sweeps_reached;
  for (int step = 0; step < options.max_sweeps; ++step) {
    if (B.cols() == 3) {
      sweep<3>(mesh, form_factors, B);
    } else {
      sweep<Eigen::Dynamic>(mesh, form_factors, B);
    }
    BandArray residual = mesh.emission + mesh.reflectance * gather(form_factors, B) - B;
    constant_mode.correct(mesh, residual, B);
    residual = mesh.emission + mesh.reflectance * gather(form_factors, B) - B;
    if (!B.allFinite()) {
      throw std::runtime_error(
          "The radiosities are no longer finite numbers; please report the scene.");
    }
    const double largest = B.abs().maxCoeff();
    solution.residual = largest > 0.0 ? residual.abs().maxCoeff() / largest : 0.0;
    solution.history.push_back(
        {.residual = solution.residual,
         .seconds =
             std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count()});
    report(options.progress, "solve", static_cast<double>(step + 1) / options.max_sweeps);
    if (solution.residual * error_per_residual <= options.tolerance) {
      solution.outcome = Outcome::converged;
      break;
    }
  }
  return solution;
}

}  // namespace lightwell
