#include "radiosity/closed_forms/polygon_form_factor.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <numbers>
#include <utility>

#include "scene/sampling.h"

namespace lightwell::polygon_form_factor_test {
namespace {

Eigen::Vector3d vec(const nlohmann::json& j) {
  return {j[0].get<double>(), j[1].get<double>(), j[2].get<double>()};
}

Loop loop(const nlohmann::json& j) {
  Loop points;
  for (const auto& p : j) points.push_back(vec(p));
  return points;
}

TEST(PointToPolygon, AgreesWithExactElementCases) {
  std::ifstream file(LIGHTWELL_TEST_DATA "/analytic/viewfactors.json");
  int tested = 0;
  for (const auto& c : nlohmann::json::parse(file)) {
    const auto& g = c["geometry"];
    if (g["type"] != "element-polygon") continue;
    const Loop polygon = loop(g["polygon"]);
    const double F = std::abs(point_to_polygon(vec(g["point"]), vec(g["normal"]), {&polygon, 1}));
    EXPECT_NEAR(F, c["value"].get<double>(), 1e-13) << c["id"];
    ++tested;
  }
  EXPECT_GE(tested, 5);
}

TEST(PointToPolygon, IsPositiveForACounterClockwiseLoopAndNegativeForAClockwiseOne) {
  // A loop at z = 1 that is counter-clockwise seen from below runs clockwise in x and y.
  const Loop loop = {{-1, -1, 1}, {-1, 1, 1}, {1, 1, 1}, {1, -1, 1}};
  const Loop reversed(loop.rbegin(), loop.rend());
  const double F = point_to_polygon({0, 0, 0}, {0, 0, 1}, {&loop, 1});
  EXPECT_GT(F, 0.0);
  EXPECT_DOUBLE_EQ(point_to_polygon({0, 0, 0}, {0, 0, 1}, {&reversed, 1}), -F);
}

TEST(PointToPolygon, HoleTakesItsShareAway) {
  const auto square = [](double s) { return Loop{{-s, -s, 1}, {-s, s, 1}, {s, s, 1}, {s, -s, 1}}; };
  const Loop outer = square(1), inner = square(0.4);
  const std::vector<Loop> with_hole = {outer, Loop(inner.rbegin(), inner.rend())};
  const Eigen::Vector3d p(0.3, 0.1, 0), n(0, 0, 1);
  EXPECT_NEAR(point_to_polygon(p, n, with_hole),
              point_to_polygon(p, n, {&outer, 1}) - point_to_polygon(p, n, {&inner, 1}), 1e-15);
}

TEST(PointToPolygon, ClosedBoxAroundAPointSumsToOne) {
  // Six faces seen from an off-centre element of any direction: closure, horizon clipping included.
  const Eigen::Vector3d p(0.21, 0.37, 0.77);
  for (int i = 0; i < 200; ++i) {
    const Eigen::Vector3d n =
        Eigen::Vector3d(random_uniform(3 * i) - 0.5, random_uniform(3 * i + 1) - 0.5,
                        random_uniform(3 * i + 2) - 0.5)
            .normalized();
    double sum = 0.0;
    for (int axis = 0; axis < 3; ++axis) {
      for (int side = 0; side < 2; ++side) {
        Loop face;
        for (const auto& [u, v] : {std::pair{0, 0}, {1, 0}, {1, 1}, {0, 1}}) {
          Eigen::Vector3d c;
          c[axis] = side;
          c[(axis + 1) % 3] = u;
          c[(axis + 2) % 3] = v;
          face.push_back(c);
        }
        sum += std::abs(point_to_polygon(p, n, {&face, 1}));
      }
    }
    EXPECT_NEAR(sum, 1.0, 1e-13);
  }
}

TEST(PointToPolygon, NothingBelowTheHorizonAndNothingFromItsOwnPlane) {
  const Loop below = {{-1, -1, -1}, {1, -1, -1}, {0, 1, -1}};
  EXPECT_EQ(point_to_polygon({0, 0, 0}, {0, 0, 1}, {&below, 1}), 0.0);
  const Loop coplanar = {{1, 0, 0}, {2, 0, 0}, {1, 1, 0}};
  EXPECT_EQ(point_to_polygon({0, 0, 0}, {0, 0, 1}, {&coplanar, 1}), 0.0);
}

// Midpoint rule over the cap of directions that meet the sphere, independent of the closed form.
double sphere_by_quadrature(double distance, double theta, double radius) {
  const double alpha = std::asin(radius / distance);
  constexpr int steps = 2000;
  double sum = 0.0;
  for (int i = 0; i < steps; ++i) {
    const double beta = alpha * (i + 0.5) / steps;
    for (int k = 0; k < steps / 4; ++k) {
      const double phi = 2.0 * std::numbers::pi * (k + 0.5) / (steps / 4);
      const double cosine =
          std::cos(beta) * std::cos(theta) + std::sin(beta) * std::sin(theta) * std::cos(phi);
      sum += std::max(0.0, cosine) * std::sin(beta);
    }
  }
  return sum * (alpha / steps) * (2.0 * std::numbers::pi / (steps / 4)) / std::numbers::pi;
}

// Once turned, corners lie above or below the point's plane by the rounding of 5 m, 1e-15 m. Around
// the point they would fill the whole hemisphere.
TEST(PointToPolygon, NothingFromItsOwnPlaneHoweverThatIsTurned) {
  for (int i = 0; i < 100; ++i) {
    const auto key = static_cast<std::uint64_t>(i);
    const Eigen::Vector3d axis(random_uniform(random_key(key, 1)) - 0.5,
                               random_uniform(random_key(key, 2)),
                               random_uniform(random_key(key, 3)));
    const Eigen::Matrix3d turn =
        Eigen::AngleAxisd(6.0 * random_uniform(random_key(key, 4)), axis.normalized()).matrix();
    const Eigen::Vector3d at = turn * Eigen::Vector3d(2.3, 1.7, 3.0), n = turn.col(2);
    Loop loop;
    for (const auto& [x, y] :
         {std::pair(2, 1), std::pair(3, 1), std::pair(3, 2), std::pair(2, 2)}) {
      loop.push_back(turn * Eigen::Vector3d(x, y, 3.0));
    }
    EXPECT_EQ(point_to_polygon(at, n, loop), 0.0) << i;
    EXPECT_EQ(point_to_polygon(at, -n, loop), 0.0) << i;
    // A gap of h = 1 um is none of that: a disc of R = 0.3 m within the square leaves less than
    // (h / R)^2 = 1.2e-11 of the hemisphere, and the sum of four edges rounds by 1e-15.
    EXPECT_NEAR(std::abs(point_to_polygon(at - 1e-6 * n, n, loop)), 1.0, 1.2e-11) << i;
  }
}

TEST(PointToSphere, AgreesWithQuadratureAboveAcrossAndBelowTheHorizon) {
  const double distance = 2.0, radius = 1.2;
  for (const double degrees : {0.0, 20.0, 50.0, 60.0, 80.0, 90.0, 100.0, 120.0, 126.0, 140.0}) {
    const double theta = degrees * std::numbers::pi / 180.0;
    const Eigen::Vector3d center(distance * std::sin(theta), 0, distance * std::cos(theta));
    // The integrand has a kink at the horizon, where the midpoint rule errs by about one cell.
    EXPECT_NEAR(point_to_sphere({0, 0, 0}, {0, 0, 1}, center, radius),
                sphere_by_quadrature(distance, theta, radius), 2e-6)
        << degrees << " degrees";
  }
}

TEST(PointToSphere, IsCosineTimesSquaredSineOfTheHalfAngleAboveTheHorizon) {
  EXPECT_NEAR(point_to_sphere({0, 0, 0}, {0, 0, 1}, {0, 0, 2}, 0.75), 0.140625, 1e-15);
}

}  // namespace
}  // namespace lightwell::polygon_form_factor_test
