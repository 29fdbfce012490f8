#include "radiosity/solve_gauss_seidel.h"

#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>

namespace lightwell {
namespace {

/// Form factors given outright.
class GivenFormFactors : public FormFactors {
 public:
  explicit GivenFormFactors(const Eigen::ArrayXXd& F) : rows_(F.rows()) {
    for (int i = 0; i < F.rows(); ++i) {
      for (int j = 0; j < F.cols(); ++j) {
        if (F(i, j) > 0.0) rows_[i].push_back({j, static_cast<float>(F(i, j))});
      }
    }
  }
  int patch_count() const override { return static_cast<int>(rows_.size()); }
  std::span<const FormFactor> row(int i) const override { return rows_[i]; }
  SpecularRow specular_row(int) const override { return {}; }
  Spectrum escaped(int) const override { return Spectrum::Zero(3); }
  Spectrum absorbed_by_specular(int) const override { return Spectrum::Zero(3); }

 private:
  std::vector<std::vector<FormFactor>> rows_;
};

PatchMesh patches(const Eigen::ArrayXd& area, const Eigen::ArrayXf& rho, const Eigen::ArrayXf& M) {
  PatchMesh mesh;
  mesh.area = area;
  mesh.reflectance = rho.replicate(1, 3);
  mesh.emission = M.replicate(1, 3);
  return mesh;
}

// Inside of a sphere cut into n equal patches: F_ij = A_j / A_sphere = 1/n exactly, so that the
// solution is uniform.
class SphereFurnace : public testing::TestWithParam<float> {};

TEST_P(SphereFurnace, RadiosityIsEmissionOverOneMinusRho) {
  const float rho = GetParam();
  constexpr int n = 64;
  const PatchMesh mesh =
      patches(Eigen::ArrayXd::Ones(n), Eigen::ArrayXf::Constant(n, rho), Eigen::ArrayXf::Ones(n));
  const auto s = solve_gauss_seidel(
      mesh, GivenFormFactors(Eigen::ArrayXXd::Constant(n, n, 1.0 / n)), {.tolerance = 1e-6});
  EXPECT_EQ(s.outcome, Outcome::converged);
  const double B = 1.0 / (1.0 - static_cast<double>(rho));
  // The bound that ended the solver, plus float rounding of B itself amplified by 1 / (1 - rho).
  const double bound = (1e-6 + 1.2e-7 / (1.0 - rho)) * B;
  EXPECT_LT((s.patch_radiosity.cast<double>() - B).abs().maxCoeff(), bound);
}
INSTANTIATE_TEST_SUITE_P(Reflectance, SphereFurnace, testing::Values(0.0f, 0.5f, 0.8f, 0.95f));

TEST(GaussSeidel, SolvesTheSixPatchBoxesExactly) {
  std::ifstream file(LIGHTWELL_TEST_DATA "/analytic/enclosures.json");
  int tested = 0;
  for (const auto& c : nlohmann::json::parse(file)) {
    if (c["kind"] != "box-coarse") continue;
    const auto& p = c["parameters"];
    const double a = p["dims"][0], b = p["dims"][1], h = p["dims"][2];
    Eigen::ArrayXd area(6);
    area << b * h, b * h, a * h, a * h, a * b, a * b;
    Eigen::ArrayXXd F(6, 6);
    PatchMesh mesh = patches(area, Eigen::ArrayXf::Zero(6), Eigen::ArrayXf::Zero(6));
    const auto band = [](const nlohmann::json& value, int k) {
      return value.is_array() ? value[k].get<float>() : value.get<float>();
    };
    for (int i = 0; i < 6; ++i) {
      for (int k = 0; k < 3; ++k) {
        mesh.reflectance(i, k) = band(p["rho"][i], k);
        mesh.emission(i, k) = band(p["E"][i], k);
      }
      for (int j = 0; j < 6; ++j) F(i, j) = c["F"][i][j];
    }
    const auto s = solve_gauss_seidel(mesh, GivenFormFactors(F), {.tolerance = 1e-7});
    for (int i = 0; i < 6; ++i) {
      for (int k = 0; k < 3; ++k) {
        const float B = band(c["expected"]["B"][i], k);
        // Form factors and radiosities are stored in float: a few units of 1.2e-7 relative.
        EXPECT_NEAR(s.patch_radiosity(i, k), B, 2e-6 * std::max(B, 0.1f)) << c["id"];
      }
    }
    ++tested;
  }
  EXPECT_GE(tested, 3);
}

TEST(GaussSeidel, ResidualFallsAndTheFuseIsReported) {
  constexpr int n = 16;
  Eigen::ArrayXf M = Eigen::ArrayXf::Zero(n);
  M[3] = 5.0f;
  Eigen::ArrayXf rho = Eigen::ArrayXf::LinSpaced(n, 0.2f, 0.9f);
  const PatchMesh mesh = patches(Eigen::ArrayXd::Ones(n), rho, M);
  const GivenFormFactors F(Eigen::ArrayXXd::Constant(n, n, 1.0 / n));
  const auto full = solve_gauss_seidel(mesh, F, {.tolerance = 1e-6});
  ASSERT_GE(full.history.size(), 2u);
  for (std::size_t i = 1; i < full.history.size(); ++i) {
    EXPECT_LT(full.history[i].residual, full.history[i - 1].residual);
  }
  const auto cut = solve_gauss_seidel(mesh, F, {.tolerance = 1e-12, .max_sweeps = 1});
  EXPECT_EQ(cut.outcome, Outcome::max_sweeps_reached);
  EXPECT_EQ(cut.history.size(), 1u);
}

TEST(GaussSeidel, StopsWhenAskedTo) {
  const PatchMesh mesh =
      patches(Eigen::ArrayXd::Ones(4), Eigen::ArrayXf::Constant(4, 0.5f), Eigen::ArrayXf::Ones(4));
  const GivenFormFactors F(Eigen::ArrayXXd::Constant(4, 4, 0.25));
  EXPECT_THROW(solve_gauss_seidel(mesh, F, {.progress = [](auto, double) { return false; }}),
               Interrupted);
}

TEST(GaussSeidel, RejectsAPatchWithoutArea) {
  const PatchMesh mesh =
      patches(Eigen::ArrayXd::Zero(2), Eigen::ArrayXf::Zero(2), Eigen::ArrayXf::Ones(2));
  EXPECT_THROW(solve_gauss_seidel(mesh, GivenFormFactors(Eigen::ArrayXXd::Zero(2, 2))),
               std::invalid_argument);
}

}  // namespace
}  // namespace lightwell
