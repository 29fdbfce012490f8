#include "radiosity/form_factors/balance.h"

#include <gtest/gtest.h>

#include "scene/sampling.h"

namespace lightwell::balance_test {
namespace {

auto product_with(const Eigen::ArrayXXd& S) {
  return [S](const Eigen::ArrayXXd& x) -> Eigen::ArrayXXd { return S.matrix() * x.matrix(); };
}

TEST(SymmetricScaling, ClosesEveryRowOfANoisySymmetricMatrix) {
  constexpr int n = 40;
  Eigen::ArrayXd area(n);
  for (int i = 0; i < n; ++i) area[i] = 0.5 + random_uniform(i);
  Eigen::ArrayXXd S(n, n);
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j <= i; ++j) {
      const double noise = 1.0 + 0.3 * (random_uniform(1000 + i * n + j) - 0.5);
      S(i, j) = S(j, i) = i == j ? 0.0 : area[i] * area[j] / area.sum() * noise;
    }
  }
  const Eigen::ArrayXd d = symmetric_scaling(product_with(S), Eigen::ArrayXd::Zero(n), area);
  for (int i = 0; i < n; ++i) {
    double sum = 0.0;
    for (int j = 0; j < n; ++j) sum += d[i] * S(i, j) * d[j];
    EXPECT_NEAR(sum / area[i], 1.0, 1e-7);
    EXPECT_NEAR(d[i], 1.0, 0.2);  // noise of at most 15 % needs corrections of that order
  }
}

TEST(SymmetricScaling, LeavesAnAlreadyClosedMatrixAlone) {
  Eigen::ArrayXXd S(2, 2);
  S << 0.25, 0.5, 0.5, 0.125;
  const Eigen::ArrayXd d =
      symmetric_scaling(product_with(S), Eigen::Array2d(0.25, 0.375), Eigen::Array2d(1.0, 1.0));
  EXPECT_NEAR(d[0], 1.0, 1e-12);
  EXPECT_NEAR(d[1], 1.0, 1e-12);
}

TEST(SymmetricScaling, EmptyRowsStayAsTheyAre) {
  const Eigen::ArrayXd d = symmetric_scaling(product_with(Eigen::ArrayXXd::Zero(2, 2)),
                                             Eigen::Array2d(0.0, 0.0), Eigen::Array2d(0.0, 1.0));
  EXPECT_EQ(d[0], 1.0);
  EXPECT_EQ(d[1], 1.0);
}

// The result of a column must not depend on its neighbours, one of which needs more iterations.
TEST(SymmetricScaling, ColumnsDoNotTouchEachOther) {
  Eigen::ArrayXXd S(2, 2), open(2, 2), target(2, 2);
  S << 0.1, 0.7, 0.7, 0.2;
  open << 0.0, 0.1, 0.0, 0.3;
  target << 1.0, 0.5, 1.0, 0.9;
  const Eigen::ArrayXXd both = symmetric_scaling(product_with(S), open, target);
  for (int k = 0; k < 2; ++k) {
    const Eigen::ArrayXd alone = symmetric_scaling(product_with(S), open.col(k), target.col(k));
    EXPECT_EQ(both(0, k), alone[0]);
    EXPECT_EQ(both(1, k), alone[1]);
  }
}

}  // namespace
}  // namespace lightwell::balance_test
