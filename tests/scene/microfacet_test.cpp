#include "scene/microfacet.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

#include "scene/sampling.h"

namespace lightwell::microfacet_test {
namespace {

constexpr double pi = std::numbers::pi;

// At normal incidence a microfacet's visible area is proportional to its cosine: the share of
// normals within theta is tan^2 / (alpha^2 + tan^2).
TEST(VisibleNormals, HeadOnTheirSlopesAreThoseOfGGX) {
  constexpr int count = 4096;
  const SobolPoints points(count);
  for (const double alpha : {0.05, 0.3, 1.0}) {
    for (const double slope : {0.3, 1.0, 3.0}) {  // in units of alpha
      int within = 0;
      for (int i = 0; i < count; ++i) {
        const Eigen::Array4f u = points.point(i, 7);
        const Eigen::Vector3d m = ggx_visible_normal({0, 0, 1}, alpha, u[0], u[1]);
        EXPECT_NEAR(m.norm(), 1.0, 1e-12);
        within += std::hypot(m.x(), m.y()) / m.z() < slope * alpha ? 1 : 0;
      }
      // Points are stratified in u: one stratum in each of 64 rows straddles the bound.
      EXPECT_NEAR(static_cast<double>(within) / count, slope * slope / (1 + slope * slope),
                  1.0 / 64.0);
    }
  }
}

// Visible normals have the means of normals of density D cos (tan^2 = alpha^2 u / (1 - u)),
// weighted by G1 max(0, o.m) / (cos_o cos_m). The weights have mean 1, the defining property of
// Lambda.
TEST(VisibleNormals, ObliquelyTheyHaveTheDensityOfWhatIsSeen) {
  constexpr int count = 1 << 14;
  const SobolPoints points(count);
  for (const double alpha : {0.1, 0.5, 1.0}) {
    for (const double degrees : {20.0, 60.0, 80.0}) {
      const double angle = degrees * pi / 180.0;
      const Eigen::Vector3d o(std::sin(angle) * 0.6, std::sin(angle) * 0.8, std::cos(angle));
      Eigen::Vector3d drawn = Eigen::Vector3d::Zero(), weighted = drawn;
      double weights = 0.0;
      for (int i = 0; i < count; ++i) {
        const Eigen::Array4d u = points.point(i, 3).cast<double>();
        drawn += ggx_visible_normal(o, alpha, u[0], u[1]);
        const double tan2 = alpha * alpha * u[2] / (1.0 - u[2]), phi = 2.0 * pi * u[3];
        const double cosine = 1.0 / std::sqrt(1.0 + tan2), sine = std::sqrt(tan2) * cosine;
        const Eigen::Vector3d m(sine * std::cos(phi), sine * std::sin(phi), cosine);
        const double weight =
            std::max(0.0, o.dot(m)) / ((1.0 + ggx_lambda(o.z(), alpha)) * o.z() * cosine);
        weights += weight;
        weighted += weight * m;
      }
      // Weights reach 1 / (cos_o cos_m): at 80 degrees and alpha 1 their spread is about 3, and
      // that of independent points would be 3 / sqrt(count) = 0.023.
      EXPECT_NEAR(weights / count, 1.0, 0.023) << alpha << " " << degrees;
      EXPECT_LT((drawn - weighted).norm() / count, 0.023) << alpha << " " << degrees;
    }
  }
}

// Microfacets cover the plane that they lie on: int D(m) cos dw = pi int D dx = 1, x = cos^2. The
// error of the midpoint rule is h^2 / 24 times the difference of the slopes at the ends, which is
// at most 2 pi / (pi alpha^4) = 2e4 at alpha 0.1: 5e-5 for h = 1/4096.
TEST(MicrofacetNormals, CoverTheirPlane) {
  constexpr int count = 4096;
  for (const double alpha : {0.1, 0.3, 1.0}) {
    double covered = 0.0;
    for (int i = 0; i < count; ++i) {
      covered += pi * ggx_normals(std::sqrt((i + 0.5) / count), alpha) / count;
    }
    EXPECT_NEAR(covered, 1.0, 1e-4) << alpha;
  }
}

TEST(SmithsLambda, VanishesHeadOnAndOnSmoothSurfaces) {
  EXPECT_EQ(ggx_lambda(1.0, 0.5), 0.0);
  EXPECT_EQ(ggx_lambda(0.2, 0.0), 0.0);
  // Lambda is (sqrt 2 - 1) / 2 for tan = 1, alpha = 1.
  EXPECT_NEAR(ggx_lambda(std::sqrt(0.5), 1.0), 0.5 * (std::sqrt(2.0) - 1.0), 1e-12);
}

}  // namespace
}  // namespace lightwell::microfacet_test
