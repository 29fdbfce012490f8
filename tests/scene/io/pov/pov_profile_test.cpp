#include "scene/io/pov/pov_profile.h"

#include <gtest/gtest.h>

#include <cmath>

namespace lightwell::pov_profile_test {
namespace {

// Sums of a few products of numbers up to 10: roundings of 2^-53.
constexpr double rounding = 1e-14;

TEST(PovProfile, CurvesPassThroughTheirPoints) {
  const std::vector<Eigen::Vector2d> points = {{1, 0}, {2, 1}, {3, 3}, {1, 4}, {2, 6}};
  const auto passes = [&](PovCurve curve, std::size_t first, std::size_t last) {
    const auto profile = pov_profile(curve, points);
    ASSERT_EQ(profile.size(), 8 * (last - first) + 1);
    for (std::size_t i = first; i <= last; ++i) {
      EXPECT_LE((profile[8 * (i - first)] - points[i]).norm(), rounding) << i;
    }
  };
  passes(PovCurve::quadratic, 1, 4);
  passes(PovCurve::cubic, 1, 3);
  passes(PovCurve::squared_radius, 1, 3);
  EXPECT_EQ(pov_profile(PovCurve::linear, points), points);
  EXPECT_TRUE(pov_profile(PovCurve::cubic, {{1, 0}, {1, 1}, {1, 2}}).empty());
}

// Curves have the shapes of their degree: a Bezier curve of points in even steps on a line, a
// parabola, a Catmull-Rom spline of points on a line, and a cylinder, whose r^2 is even.
TEST(PovProfile, CurvesReproduceWhatTheirDegreeAllows) {
  for (const auto& p : pov_profile(PovCurve::bezier, {{0, 0}, {1, 2}, {2, 4}, {3, 6}})) {
    EXPECT_NEAR(p.y(), 2.0 * p.x(), rounding);
  }
  for (const auto& p : pov_profile(PovCurve::quadratic, {{-1, 1}, {0, 0}, {1, 1}})) {
    EXPECT_NEAR(p.y(), p.x() * p.x(), rounding);
  }
  for (const auto& p : pov_profile(PovCurve::cubic, {{0, 1}, {1, 2}, {2, 3}, {3, 4}})) {
    EXPECT_NEAR(p.y(), p.x() + 1.0, rounding);
  }
  for (const auto& p : pov_profile(PovCurve::squared_radius, {{2, 0}, {2, 1}, {2, 3}, {2, 4}})) {
    EXPECT_NEAR(p.x(), 2.0, rounding);
  }
}

}  // namespace
}  // namespace lightwell::pov_profile_test
