#include "radiosity/solve_gauss_seidel.h"

#include <fmt/format.h>

#include <chrono>
#include <cmath>
#include <stdexcept>

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

// alpha per band with sum_i A_i (residual of B + alpha v)_i = 0, where v = rho / max rho: the shape
// a room's interreflected light has at leisure.
struct ConstantMode {
  BandArray shape{};
  Eigen::ArrayXd drain{};  // sum_i A_i (v - rho F v)_i per band

  ConstantMode(const PatchMesh& mesh, const FormFactors& form_factors) {
    shape = (mesh.reflectance > 0.0f).cast<float>();
    const BandArray operated = shape - mesh.reflectance * gather(form_factors, shape);
    drain = (operated.cast<double>().colwise() * mesh.area).colwise().sum().transpose();
  }

  void correct(const PatchMesh& mesh, const BandArray& residual, BandArray& B) const {
    for (Eigen::Index k = 0; k < B.cols(); ++k) {
      const double excess = (residual.col(k).cast<double>() * mesh.area).sum();
      const double alpha = excess / drain[k];
      // A nearly lossless room has nothing to divide by; the sweeps then converge alone.
      if (!(drain[k] > 1e-9 * mesh.area.sum()) || !std::isfinite(alpha)) continue;
      B.col(k) += static_cast<float>(alpha) * shape.col(k);
    }
  }
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
