#include "raytrace/readings/glare.h"
#include "scene/lamp_faces.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <memory>
#include <numbers>
#include <string>
#include <vector>

#include "tests/raytrace/lit_scene.h"

namespace lightwell::glare_test {
namespace {

constexpr double pi = std::numbers::pi;
constexpr double degrees = 180.0 / pi;

/// The first row of table 4.1 of CIE 117-1995: straight above the line of sight, by height over
/// distance, in steps of 0.1. Levin's formula agrees to 4 %, a third of a unit of UGR.
TEST(PositionIndex, IsThatOfTheStandard) {
  constexpr std::array<double, 11> table = {1.00, 1.26, 1.53, 1.90, 2.35, 2.86,
                                            3.50, 4.20, 5.00, 6.00, 7.00};
  for (std::size_t i = 0; i < table.size(); ++i) {
    const double sigma = std::atan(0.1 * static_cast<double>(i)) * degrees;
    EXPECT_NEAR(position_index(sigma, 0.0), table[i], 0.04 * table[i]) << i;
  }
}

TEST(PositionIndex, RisesAwayFromTheLineOfSight) {
  for (const double tau : {0.0, 45.0, 90.0, 135.0, 180.0}) {
    EXPECT_NEAR(position_index(0.0, tau), 1.0, 1e-12);
    for (double sigma = 2.0; sigma < 85.0; sigma += 2.0) {
      EXPECT_GT(position_index(sigma, tau), position_index(sigma - 2.0, tau)) << tau;
    }
  }
}

constexpr double single = 1e-6;  // relative error of sums of a few floats

constexpr float M = 1000.0f, rho = 0.5f, E = 2.0f;

/// A room of constant reflected light, L_b = rho E / pi, with a small luminaire.
TracedScene& lit_room(const Eigen::Vector3d& luminaire) {
  static std::unique_ptr<TracedScene> lit;
  const Paint wall{.reflectance = rho, .one_sided = true};
  const Eigen::Vector3d towards = (Eigen::Vector3d(2, 1, 1.2) - luminaire).normalized();
  lit = std::make_unique<TracedScene>(
      SceneBuilder()
          .box(wall, {0, 0, 0}, {4, 6, 3}, true)
          .square({.reflectance = rho, .exitance = M, .one_sided = true}, luminaire, towards, 0.05)
          .build());
  lit->set_indirect([](const auto&) { return E; });
  return *lit;
}

Camera eye() {
  return {.name = "eye",
          .position = {2, 1, 1.2},
          .direction = Eigen::Vector3d::UnitY(),
          .up = Eigen::Vector3d::UnitZ()};
}

Glare rating(const TracedScene& lit, const Camera& camera,
             const std::vector<double>& heights = {}) {
  const DirectLight direct_light(lit.scene, lit.caster.mesh());  // includes lamps added later
  return unified_glare_rating(lit.scene, lit.caster, direct_light, lit.solution, camera,
                              {.rays = 256}, heights);
}

/// CIE 117 by hand for a square of 0.1 m at 4 m and 1.2 m above the line of sight, facing the eye.
TEST(UnifiedGlareRating, OfASmallLuminaireIsTheFormulas) {
  const TracedScene& lit = lit_room({2, 5, 2.4});
  const Glare glare = rating(lit, eye());
  const double d2 = 4.0 * 4.0 + 1.2 * 1.2;
  const double L = luminous(lit.scene.bands, constant_spectrum(lit.scene.bands, M)) / pi;
  const double L_b = luminous(lit.scene.bands, constant_spectrum(lit.scene.bands, rho * E)) / pi;
  const double omega = 0.01 / d2, p = position_index(std::atan(0.3) * degrees, 0.0);
  ASSERT_EQ(glare.sources.size(), 1u);
  EXPECT_EQ(glare.sources[0].name, "surface 1");
  EXPECT_NEAR(glare.sources[0].luminance, L, single * L);
  // The formula treats the square as its centre. Half of its width subtends 0.7 degrees = 0.012
  // rad, over which p changes by 2.8 %: the errors are the squares of both, and in UGR 2 * 8 / ln
  // 10 times that of p.
  EXPECT_NEAR(glare.sources[0].solid_angle, omega, 1.5e-4 * omega);
  EXPECT_NEAR(glare.sources[0].position_index, p, 8e-4 * p);
  EXPECT_NEAR(glare.background, L_b, single * L_b);
  ASSERT_TRUE(glare.ugr.has_value());
  EXPECT_NEAR(*glare.ugr, 8.0 * std::log10(0.25 / L_b * L * L * omega / (p * p)), 0.006);
}

/// A luminaire 1.7 m above the line of sight is within 1.9 times a distance of 1 m, and beyond 1.9
/// times a distance of 0.8 m.
TEST(UnifiedGlareRating, EndsWhereTheStandardsTableEnds) {
  EXPECT_TRUE(rating(lit_room({2, 2, 2.9}), eye()).ugr.has_value());
  EXPECT_FALSE(rating(lit_room({2, 1.8, 2.9}), eye()).ugr.has_value());
}

TEST(UnifiedGlareRating, IsEmptyBehindTheEyeAndBehindAWall) {
  EXPECT_FALSE(rating(lit_room({2, 0.5, 2.4}), eye()).ugr.has_value());
  const Paint wall{.reflectance = rho};
  TracedScene hidden(SceneBuilder()
                         .box({.reflectance = rho, .one_sided = true}, {0, 0, 0}, {4, 6, 3}, true)
                         .square({.exitance = M, .one_sided = true}, {2, 5, 2.4}, {0, -1, 0}, 0.05)
                         .square(wall, {2, 4, 2}, {0, -1, 0}, 0.9)
                         .build());
  hidden.set_indirect([](const auto&) { return E; });
  EXPECT_FALSE(rating(hidden, eye()).ugr.has_value());
}

/// A lamp with an opening of 0.1 m x 0.2 m, seen at 45 degrees.
Lamp downlight() {
  return {.name = "downlight",
          .position = {2, 2, 2.2},
          .intensity = constant_spectrum(rgb_bands(), 3.0f),
          .opening = {.along_c0 = 0.1, .along_c90 = 0.2}};
}

/// L = I / (A cos), w = A cos / d^2.
TEST(UnifiedGlareRating, OfALampGoesByItsOpening) {
  TracedScene& lit = lit_room({2, 0.5, 2.4});  // the surface is behind
  const Lamp lamp = downlight();
  lit.scene.lamps = {lamp, {.name = "bulb", .position = {2, 3, 2}}};
  lit.scene.lamps[1].intensity = lamp.intensity;
  const Glare glare = rating(lit, eye());
  const double I = luminous(lit.scene.bands, lamp.intensity), A = 0.02, cosine = std::sqrt(0.5);
  const double d2 = 2.0;
  ASSERT_EQ(glare.sources.size(), 1u);
  const GlareSource& seen = glare.sources[0];
  // Half of its length over the distance is 0.07 and subtends 2.9 degrees, over which p changes by
  // 15 %: the errors are the squares of both, that of p averaged over the length.
  EXPECT_NEAR(seen.luminance, I / (A * cosine), 5e-3 * I / (A * cosine));
  EXPECT_NEAR(seen.solid_angle, A * cosine / d2, 5e-3 * A * cosine / d2);
  EXPECT_NEAR(seen.position_index, position_index(45.0, 0.0), 8e-3 * position_index(45.0, 0.0));
  EXPECT_EQ(glare.left_out, std::vector<std::string>{"bulb"});
}

/// Sides of 0.05 m height add the projected area of a box's sides, or of a cylinder's outline.
TEST(LuminousArea, IsThatOfOpeningAndSides) {
  const LampOpening box{.along_c0 = 0.1, .along_c90 = 0.2};
  const double half = std::sqrt(0.5);
  EXPECT_DOUBLE_EQ(luminous_area(box, 0.0, {0, half, half}), 0.02 * half);
  EXPECT_DOUBLE_EQ(luminous_area(box, 0.05, {0, half, half}), (0.02 + 0.05 * 0.1) * half);
  EXPECT_DOUBLE_EQ(luminous_area(box, 0.05, {0, -1, 0}), 0.05 * 0.1);
  EXPECT_DOUBLE_EQ(luminous_area(box, 0.05, {half, half, 0}), 0.05 * (0.1 + 0.2) * half);
  const LampOpening drum{.along_c0 = 0.2, .along_c90 = 0.2, .is_round = true};
  EXPECT_DOUBLE_EQ(luminous_area(drum, 0.05, {half, half, 0}), 0.05 * 0.2);
  EXPECT_DOUBLE_EQ(luminous_area(drum, 0.05, {0, 0, 1}), pi * 0.01);
}

TEST(UnifiedGlareRating, OfALampCountsItsLuminousSides) {
  TracedScene& lit = lit_room({2, 0.5, 2.4});  // the surface is behind
  lit.scene.lamps = {downlight()};
  const Glare glare = rating(lit, eye(), {0.05});
  const double I = luminous(lit.scene.bands, downlight().intensity);
  const double area = (0.02 + 0.05 * 0.1) * std::sqrt(0.5), L = I / area;
  ASSERT_EQ(glare.sources.size(), 1u);
  // Beside the errors of the downlight, points off the middle, on average 0.025 m at 1.41 m,
  // project the sides that face C0: 0.018 * 0.2 m * 0.05 m, a hundredth of the area.
  EXPECT_NEAR(glare.sources[0].luminance, L, 1.5e-2 * L);
  EXPECT_NEAR(glare.sources[0].solid_angle, area / 2.0, 1.5e-2 * area / 2.0);
}

}  // namespace
}  // namespace lightwell::glare_test
