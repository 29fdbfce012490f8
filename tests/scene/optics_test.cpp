#include "scene/optics.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <numbers>

namespace lightwell::optics_test {
namespace {

// Both values are doubles of the same closed form; near the critical angle the square root
// magnifies rounding to about 1e-11.
constexpr double tolerance = 1e-9;
constexpr double degree = std::numbers::pi / 180.0;

nlohmann::json reference(const std::string& id) {
  std::ifstream file(LIGHTWELL_TEST_DATA "/scene/optics.json");
  for (const auto& item : nlohmann::json::parse(file)) {
    if (item.at("id") == id) return item;
  }
  throw std::runtime_error("no reference " + id);
}

Eigen::Vector3d vector(const nlohmann::json& j) {
  return {j.at(0).get<double>(), j.at(1).get<double>(), j.at(2).get<double>()};
}

TEST(Pane, PassesWhatASlabOfGlassDoesWithoutItsThickness) {
  const auto item = reference("slab-clear");
  for (const auto& [angle, expected] : item.at("expected").items()) {
    const double cosine = std::cos(std::stod(angle) * degree);
    EXPECT_NEAR(1.0 - pane_reflectance(cosine, item.at("parameters").at("n").get<double>()),
                expected.at("T").get<double>(), tolerance)
        << angle;
  }
}

TEST(Pane, ReflectsAllWhereOneOfItsFacesDoes) {
  EXPECT_EQ(pane_reflectance(0.5, 0.6), 1.0);
}

// The share of light that a pane passes after going to and fro inside: with the
// reflectance r of a face and the share d of one crossing, (1 - r)^2 d (r d)^2k passes after 2k
// reflections inside, and r + (1 - r)^2 r d^2 (r d)^2k comes back.
TEST(Pane, WithABodyPassesTheSumOfItsInnerReflections) {
  constexpr double index = 1.52;
  for (const double t : {0.0, 0.25, 0.654047, 1.0}) {
    for (const double degrees : {0.0, 30.0, 60.0, 80.0, 89.0}) {
      const double cosine = std::cos(degrees * degree);
      const double refracted = std::asin(std::sin(degrees * degree) / index);
      const double d = std::pow(t, 1.0 / std::cos(refracted));
      const PolarisedReflectance face = polarised_reflectance(cosine, index);
      double passed = 0.0, reflected = 0.0;
      for (const double r : {face.s, face.p}) {
        reflected += 0.5 * r;
        double inside = (1.0 - r) * d;  // that arrives at the back
        // At 89 degrees r is 0.94, and 0.94^800 is below the tolerance.
        for (int k = 0; k < 400; ++k) {
          passed += 0.5 * (1.0 - r) * inside;
          inside *= r * d;
          reflected += 0.5 * (1.0 - r) * inside;
          inside *= r * d;
        }
      }
      const PaneShares shares = pane_shares(cosine, index, t);
      EXPECT_NEAR(shares.passed, passed, tolerance) << t << ' ' << degrees;
      EXPECT_NEAR(shares.reflected, reflected, tolerance) << t << ' ' << degrees;
    }
  }
}

TEST(Pane, WithAClearBodyIsAClearPane) {
  for (const double cosine : {1.0, 0.5, 0.1, 0.0}) {
    const PaneShares shares = pane_shares(cosine, 1.5, 1.0);
    EXPECT_NEAR(shares.reflected, pane_reflectance(cosine, 1.5), tolerance);
    EXPECT_NEAR(shares.passed, 1.0 - pane_reflectance(cosine, 1.5), tolerance);
  }
  const PaneShares total = pane_shares(0.5, 0.6, 0.5);
  EXPECT_EQ(total.reflected, 1.0);
  EXPECT_EQ(total.passed, 0.0);
}

class Boundary : public testing::TestWithParam<const char*> {};

TEST_P(Boundary, ReflectsByFresnelAndRefractsBySnell) {
  const auto item = reference(GetParam());
  const double n1 = item.at("parameters").at("n1"), n2 = item.at("parameters").at("n2");
  for (const auto& [angle, expected] : item.at("expected").items()) {
    const double theta = std::stod(angle) * degree;
    EXPECT_NEAR(fresnel_reflectance(std::cos(theta), n2 / n1), expected.at("R").get<double>(),
                tolerance)
        << angle;
    const Eigen::Vector3d in(std::sin(theta), 0.0, -std::cos(theta));
    const auto out = refract(in, Eigen::Vector3d::UnitZ(), n2 / n1);
    ASSERT_EQ(out.has_value(), !expected.at("tir").get<bool>()) << angle;
    if (!out) continue;
    const double theta_t = expected.at("theta_t_deg").get<double>() * degree;
    EXPECT_NEAR(out->x(), std::sin(theta_t), tolerance) << angle;
    EXPECT_NEAR(out->z(), -std::cos(theta_t), tolerance) << angle;
  }
}
INSTANTIATE_TEST_SUITE_P(AirAndGlass, Boundary,
                         testing::Values("fresnel-air-glass", "fresnel-glass-air"));

TEST(Optics, VectorsFollowTheLawsInAnyFrame) {
  const auto cases = reference("reflect-refract-vectors").at("expected");
  ASSERT_EQ(cases.size(), 4u);
  for (const auto& item : cases) {
    const Eigen::Vector3d d = vector(item.at("d")), n = vector(item.at("n"));
    EXPECT_LT((reflect(d, n) - vector(item.at("reflect"))).norm(), tolerance);
    const auto out = refract(d, n, item.at("n2").get<double>() / item.at("n1").get<double>());
    ASSERT_EQ(out.has_value(), !item.at("total_internal_reflection").get<bool>());
    if (!out) continue;
    EXPECT_LT((*out - vector(item.at("refract"))).norm(), tolerance);
  }
}

TEST(Optics, ReflectanceIsTheSameFromBothSidesOfTheBoundary) {
  for (double theta = 0.0; theta < 89.5; theta += 1.0) {
    const double inside = std::asin(std::sin(theta * degree) / 1.5);
    EXPECT_NEAR(fresnel_reflectance(std::cos(theta * degree), 1.5),
                fresnel_reflectance(std::cos(inside), 1.0 / 1.5), tolerance);
  }
}

TEST(Optics, RefractionIsReversible) {
  const Eigen::Vector3d in = Eigen::Vector3d(0.3, 0.5, -0.7).normalized();
  const auto out = refract(in, Eigen::Vector3d::UnitZ(), 1.33);
  ASSERT_TRUE(out);
  EXPECT_NEAR(out->norm(), 1.0, tolerance);
  const auto back = refract(-*out, -Eigen::Vector3d::UnitZ(), 1.0 / 1.33);
  ASSERT_TRUE(back);
  EXPECT_LT((*back + in).norm(), tolerance);
}

TEST(Optics, GrazingLightIsReflectedAndEqualIndicesDoNothing) {
  EXPECT_NEAR(fresnel_reflectance(0.0, 1.5), 1.0, tolerance);
  EXPECT_NEAR(fresnel_reflectance(0.4, 1.0), 0.0, tolerance);
}

}  // namespace
}  // namespace lightwell::optics_test
