#include "raytrace/readings/glare_rating.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "scene/degree.h"
#include "tests/raytrace/lit_scene.h"

namespace lightwell::glare_rating_test {
namespace {

using Eigen::Vector3d;

Vector3d at_angle(double degrees) {
  return {std::cos(degrees * degree), 0.0, std::sin(degrees * degree)};
}

/// CIE 112 by hand: 2 lx from 10 degrees off the line of sight give L_vl = 10 * 2 cos(10) / 10^2 =
/// 0.1969616 cd/m^2; a pitch of 200 lx and reflectance 0.2 gives L_ve = 0.035 * 200 * 0.2 / pi =
/// 0.4456338; R_G = 27 + 24 log10(0.1969616 / 0.4456338^0.9). Seven digits stand here.
TEST(GlareRating, IsThatOfTheFormula) {
  const std::vector<ArrivingLight> one = {{at_angle(10.0), 2.0}};
  const double veil = veiling_luminance(one, Vector3d::UnitX());
  EXPECT_NEAR(veil, 0.1969616, 1e-7);
  EXPECT_NEAR(environment_veil(200.0, 0.2), 0.4456338, 1e-7);
  EXPECT_NEAR(glare_rating(veil, 0.4456338), 17.647227, 1e-5);
  EXPECT_EQ(glare_rating(0.0, 1.0), 0.0);
}

/// Lights nearer than 1.5 degrees to the line of sight and beyond 60 do not count.
TEST(GlareRating, CountsLightsBetweenTwoAngles) {
  for (const double angle : {1.4, 60.1, 120.0}) {
    EXPECT_EQ(veiling_luminance({{at_angle(angle), 1.0}}, Vector3d::UnitX()), 0.0) << angle;
  }
  EXPECT_GT(veiling_luminance({{at_angle(1.6), 1.0}}, Vector3d::UnitX()),
            veiling_luminance({{at_angle(59.0), 1.0}}, Vector3d::UnitX()));
}

/// A light `high` degrees above the horizon, turned by a from a line of sight 2 degrees below it,
/// is theta off, with cos theta = cos(high) cos(2) cos(a) - sin(high) sin(2). The steps of a
/// quarter of a degree leave a = 0 for azimuths of whole steps and a = 0.125 for those between,
/// which multiples of 7.125 are in turn. R_G is that of theta, to rounding, and the bound holds the
/// difference.
TEST(GlareRating, OfAnEyeIsTheWorstOfAllDirections) {
  const auto rated_at = [](double high, double off) {
    const double theta =
        std::acos(std::cos(high * degree) * std::cos(2.0 * degree) * std::cos(off * degree) -
                  std::sin(high * degree) * std::sin(2.0 * degree)) /
        degree;
    return glare_rating(veiling_luminance({{at_angle(theta), 2.0}}, Vector3d::UnitX()), 0.5);
  };
  for (const double high : {0.0, 10.0, 50.0}) {
    EXPECT_LT(rated_at(high, 0.0), rated_at(high, 0.125) + glare_rating_step_within);
    for (int i = 0; i < 50; ++i) {
      const double azimuth = 7.125 * i;
      const Vector3d towards(std::cos(high * degree) * std::cos(azimuth * degree),
                             std::cos(high * degree) * std::sin(azimuth * degree),
                             std::sin(high * degree));
      EXPECT_NEAR(greatest_glare_rating({{towards, 2.0}}, 0.5, Vector3d::UnitZ()),
                  rated_at(high, i % 2 == 0 ? 0.0 : 0.125), 1e-9)
          << high << " " << azimuth;
    }
  }
}

/// I / d^2 of a lamp, and L A cos / d^2 of an emitting square of 0.1 m that faces the eye from 4 m,
/// which is about that of its middle: half its diagonal is 0.018 of the distance, whose square is
/// the error. A wall hides both.
TEST(GlareRating, KnowsTheLightThatArrives) {
  const Paint black{.one_sided = true}, wall{};
  const auto scene_with = [&](bool has_wall) {
    SceneBuilder builder;
    builder.box(black, {-5, -5, 0}, {5, 5, 5}, true)
        .square({.exitance = 100.0f, .one_sided = true}, {4, 0, 1}, {-1, 0, 0}, 0.05);
    if (has_wall) builder.square(wall, {1, 0, 2}, {1, 0, 0}, 3.0);
    return builder.build();
  };
  const Vector3d eye(0, 0, 1);
  for (const bool has_wall : {false, true}) {
    TracedScene lit(scene_with(has_wall));
    lit.scene.lamps = {
        {.name = "bulb", .position = {3, 0, 4}, .intensity = constant_spectrum(rgb_bands(), 2.0f)}};
    const DirectLight direct_light(lit.scene, lit.caster.mesh());
    const auto arriving = arriving_light(lit.scene, lit.caster, direct_light, eye);
    double of_square = 0.0, of_lamp = 0.0;
    for (const ArrivingLight& light : arriving) {
      const bool is_lamp = light.direction.z() > 0.5;
      (is_lamp ? of_lamp : of_square) += light.lux;
    }
    const auto lux = [&](float watts) {
      return luminous(lit.scene.bands, constant_spectrum(rgb_bands(), watts));
    };
    const double square = lux(100.0f) / std::numbers::pi * 0.01 / 16.0, lamp = lux(2.0f) / 18.0;
    EXPECT_NEAR(of_square, has_wall ? 0.0 : square, 4e-4 * square);
    EXPECT_NEAR(of_lamp, has_wall ? 0.0 : lamp, 1e-6 * lamp);
  }
}

}  // namespace
}  // namespace lightwell::glare_rating_test
