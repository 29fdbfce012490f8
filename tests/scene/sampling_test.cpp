#include "scene/sampling.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <set>
#include <vector>

namespace lightwell::sampling_test {
namespace {

class ScrambledSobol : public testing::TestWithParam<int> {};

TEST_P(ScrambledSobol, EveryDimensionHitsEachStratumOnce) {
  const int n = 1 << GetParam();
  const SobolPoints points(n);
  for (std::uint64_t key = 1; key <= 5; ++key) {
    for (int d = 0; d < 4; ++d) {
      std::vector<int> hits(n, 0);
      for (int i = 0; i < n; ++i) ++hits[static_cast<int>(points.point(i, random_key(key))[d] * n)];
      EXPECT_EQ(hits, std::vector<int>(n, 1)) << "key " << key << ", dimension " << d;
    }
  }
}

TEST_P(ScrambledSobol, FirstTwoDimensionsHitEachElementaryIntervalOnce) {
  // The first two Sobol dimensions are a (0, m, 2)-net in base 2, and scrambling keeps that.
  const int m = GetParam(), n = 1 << m;
  const SobolPoints points(n);
  for (std::uint64_t key = 1; key <= 3; ++key) {
    for (int columns = 0; columns <= m; ++columns) {
      const int width = 1 << columns, height = 1 << (m - columns);
      std::vector<int> hits(n, 0);
      for (int i = 0; i < n; ++i) {
        const Eigen::Array4f p = points.point(i, random_key(key));
        ++hits[static_cast<int>(p[0] * width) * height + static_cast<int>(p[1] * height)];
      }
      EXPECT_EQ(hits, std::vector<int>(n, 1)) << width << " x " << height;
    }
  }
}
INSTANTIATE_TEST_SUITE_P(PowersOfTwo, ScrambledSobol, testing::Values(0, 1, 4, 7, 10));

TEST(SobolPoints, AnyTwoDimensionsFillTheSquareEvenly) {
  // All six projections of 1024 points onto 8 x 8 cells: 16 a cell for a perfect net. The Sobol
  // sequence of Joe & Kuo has quality t <= 2 in these pairs, so a cell of 2^-6 holds a multiple of
  // 2^t <= 4 exactly, i.e. still 16.
  const SobolPoints points(1024);
  for (int a = 0; a < 4; ++a) {
    for (int b = a + 1; b < 4; ++b) {
      std::vector<int> hits(64, 0);
      for (int i = 0; i < 1024; ++i) {
        const Eigen::Array4f p = points.point(i, random_key(11));
        ++hits[static_cast<int>(p[a] * 8) * 8 + static_cast<int>(p[b] * 8)];
      }
      EXPECT_EQ(hits, std::vector<int>(64, 16)) << a << ", " << b;
    }
  }
}

TEST(SobolPoints, KeysGiveDifferentPointsInTheUnitCube) {
  const SobolPoints points(64);
  std::set<std::array<float, 4>> seen;
  for (std::uint64_t key = 0; key < 100; ++key) {
    const Eigen::Array4f p = points.point(0, random_key(key, 7));
    EXPECT_TRUE((p >= 0.0f).all() && (p < 1.0f).all());
    seen.insert({p[0], p[1], p[2], p[3]});
  }
  EXPECT_EQ(seen.size(), 100u);
}

// Root of the mean squared error over 64 keys for the integral of prod_d (1 + (x_d - 1/2)) = 1.
double rms_error(int n) {
  const SobolPoints points(n);
  double squares = 0.0;
  for (std::uint64_t key = 0; key < 64; ++key) {
    double sum = 0.0;
    for (int i = 0; i < n; ++i)
      sum += (0.5 + points.point(i, random_key(key, 3)).cast<double>()).prod();
    squares += (sum / n - 1.0) * (sum / n - 1.0);
  }
  return std::sqrt(squares / 64);
}

TEST(SobolPoints, TogetherOrOneByOneAreTheSame) {
  const SobolPoints sobol(64);
  std::vector<Eigen::Array4f> together(20);
  sobol.points(30, 99, together);
  for (int i = 0; i < 20; ++i) {
    EXPECT_TRUE((together[static_cast<std::size_t>(i)] == sobol.point(30 + i, 99)).all());
  }
}

TEST(SobolPoints, ErrorFallsFasterThanOneOverRootN) {
  // 16 times the points: independent samples would gain 4; a scrambled net of a smooth function has
  // error O(N^-3/2) up to logarithms (Owen 1997), 64. Twice the former is required.
  EXPECT_GT(rms_error(256) / rms_error(4096), 8.0);
  // Without bias the error is far below that of independent samples, 0.037 at 256 points.
  EXPECT_LT(rms_error(256), 0.037 / 4);
}

TEST(RandomKey, DependsOnEveryArgument) {
  std::set<std::uint64_t> keys;
  for (std::uint64_t a = 0; a < 4; ++a) {
    for (std::uint64_t b = 0; b < 4; ++b) {
      for (std::uint64_t c = 0; c < 4; ++c) {
        for (std::uint64_t d = 0; d < 4; ++d) keys.insert(random_key(a, b, c, d));
      }
    }
  }
  EXPECT_EQ(keys.size(), 256u);
}

TEST(RandomUniform, IsUniform) {
  // 100 cells of 1000 expected: chi-square with 99 degrees of freedom, 99.9 % below 149.
  std::vector<int> hits(100, 0);
  for (std::uint64_t i = 0; i < 100000; ++i) {
    const double u = random_uniform(random_key(i));
    ASSERT_GE(u, 0.0);
    ASSERT_LT(u, 1.0);
    ++hits[static_cast<std::size_t>(u * 100)];
  }
  double chi_square = 0.0;
  for (int h : hits) chi_square += (h - 1000.0) * (h - 1000.0) / 1000.0;
  EXPECT_LT(chi_square, 149.0);
}

TEST(CosineDirection, HasTheMomentsOfLambertsLaw) {
  constexpr int n = 4096;
  const SobolPoints points(n);
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  Eigen::Matrix3d second = Eigen::Matrix3d::Zero();
  for (int i = 0; i < n; ++i) {
    const Eigen::Array4f p = points.point(i, 5);
    const Eigen::Vector3d w = cosine_direction(p[0], p[1]);
    EXPECT_NEAR(w.norm(), 1.0, 1e-12);
    EXPECT_GE(w.z(), 0.0);
    mean += w / n;
    second += w * w.transpose() / n;
  }
  // With density cos/pi: E[w] = (0, 0, 2/3), E[w w'] = diag(1/4, 1/4, 1/2). Stratification keeps
  // the error of 4096 points near 1 / 4096; independent samples would be at 0.01.
  EXPECT_LT((mean - Eigen::Vector3d(0, 0, 2.0 / 3.0)).norm(), 1e-3);
  EXPECT_LT((second - Eigen::Vector3d(0.25, 0.25, 0.5).asDiagonal().toDenseMatrix()).norm(), 1e-3);
}

TEST(CosineDirection, CentreOfTheSquareIsThePole) {
  EXPECT_EQ(cosine_direction(0.5f, 0.5f), Eigen::Vector3d::UnitZ());
}

TEST(TangentFrame, IsRightHandedAndOrthonormal) {
  std::vector<Eigen::Vector3d> normals = {{0, 0, 1}, {0, 0, -1}, {1, 0, 0}, {0, -1, 0}};
  for (std::uint64_t i = 0; i < 1000; ++i) {
    Eigen::Vector3d n;
    for (std::uint64_t c = 0; c < 3; ++c) {
      n[static_cast<int>(c)] = random_uniform(random_key(i, c)) - 0.5;
    }
    normals.push_back(n.normalized());
  }
  for (const auto& n : normals) {
    Eigen::Vector3d a, b;
    tangent_frame(n, a, b);
    Eigen::Matrix3d frame;
    frame << a, b, n;
    EXPECT_LT((frame.transpose() * frame - Eigen::Matrix3d::Identity()).norm(), 1e-12)
        << n.transpose();
    EXPECT_LT((a.cross(b) - n).norm(), 1e-12) << n.transpose();
  }
}

TEST(TrianglePoint, WeightsAreUniformOverTheTriangle) {
  constexpr int n = 4096;
  const SobolPoints points(n);
  Eigen::Vector3d mean = Eigen::Vector3d::Zero(), squares = Eigen::Vector3d::Zero();
  for (int i = 0; i < n; ++i) {
    const Eigen::Array4f p = points.point(i, 9);
    const Eigen::Vector3d w = triangle_point(p[0], p[1]);
    EXPECT_NEAR(w.sum(), 1.0, 1e-12);
    EXPECT_GE(w.minCoeff(), 0.0);
    mean += w / n;
    squares += w.cwiseProduct(w) / n;
  }
  // Uniform (Dirichlet) weights: mean 1/3, mean square 1/6.
  EXPECT_LT((mean.array() - 1.0 / 3.0).abs().maxCoeff(), 1e-3);
  EXPECT_LT((squares.array() - 1.0 / 6.0).abs().maxCoeff(), 1e-3);
}

}  // namespace
}  // namespace lightwell::sampling_test
