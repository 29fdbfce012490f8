#include "radiosity/balance.h"

#include <gtest/gtest.h>

#include "scene/sampling.h"

namespace lightwell {
namespace {

SparseRows dense(const Eigen::ArrayXXd& S) {
  SparseRows rows;
  rows.first.push_back(0);
  for (int i = 0; i < S.rows(); ++i) {
    for (int j = 0; j < S.cols(); ++j) {
      if (S(i, j) == 0.0) continue;
      rows.column.push_back(j);
      rows.value.push_back(static_cast<float>(S(i, j)));
    }
    rows.first.push_back(static_cast<std::int64_t>(rows.column.size()));
  }
  return rows;
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
  const Eigen::ArrayXd d = symmetric_scaling(dense(S), Eigen::ArrayXd::Zero(n), area);
  for (int i = 0; i < n; ++i) {
    double sum = 0.0;
    for (int j = 0; j < n; ++j) sum += d[i] * S(i, j) * d[j];
    EXPECT_NEAR(sum / area[i], 1.0, 1e-7);
    EXPECT_NEAR(d[i], 1.0, 0.2);  // noise of 15 % at most calls for corrections of that order
  }
}

TEST(SymmetricScaling, LeavesAnAlreadyClosedMatrixAlone) {
  const Eigen::ArrayXXd S = (Eigen::ArrayXXd(2, 2) << 0.25, 0.5, 0.5, 0.125).finished();
  const Eigen::ArrayXd d =
      symmetric_scaling(dense(S), Eigen::Array2d(0.25, 0.375), Eigen::Array2d(1.0, 1.0));
  EXPECT_NEAR(d[0], 1.0, 1e-12);
  EXPECT_NEAR(d[1], 1.0, 1e-12);
}

TEST(SymmetricScaling, EmptyRowsStayAsTheyAre) {
  SparseRows S{.first = {0, 0, 0}};
  const Eigen::ArrayXd d = symmetric_scaling(S, Eigen::Array2d(0.0, 0.0), Eigen::Array2d(0.0, 1.0));
  EXPECT_EQ(d[0], 1.0);
  EXPECT_EQ(d[1], 1.0);
}

}  // namespace
}  // namespace lightwell
