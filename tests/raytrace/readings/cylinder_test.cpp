#include "raytrace/readings/cylinder.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "scene/errors.h"
#include "tests/raytrace/lit_scene.h"
#include "tests/temporary_folder.h"

namespace lightwell::cylinder_test {
namespace {

constexpr double pi = std::numbers::pi;
const Eigen::Vector3d up = Eigen::Vector3d::UnitZ();
const Paint panel{.exitance = 10.0f, .one_sided = true};
const double radiance = luminous(rgb_bands(), constant_spectrum(rgb_bands(), 10.0f)) / pi;

/// A black floor of 0.2 m, over whose middle grids have one point.
SceneBuilder small_floor() {
  return SceneBuilder().polygon({},
                                {{-0.1, -0.1, 0}, {0.1, -0.1, 0}, {0.1, 0.1, 0}, {-0.1, 0.1, 0}});
}

LuxField measure_one(const TracedScene& lit, GridQuantity quantity,
                     const Eigen::Vector3d& facing = Eigen::Vector3d::UnitX()) {
  LuxGrid grid = lux_grid(lit.scene, 0, up, {.height = 1.2, .spacing = 1.0});
  EXPECT_EQ(grid.points.size(), 1u);
  measure_as(quantity, up, facing, grid);
  return measure_grid(lit.scene, lit.caster, lit.direct_light, lit.solution, grid, 1.0,
                      {.rays = 64});
}

/// A disc of half angle t over the point: E_z = L (t - sin t cos t), and half of the cylinder gets
/// as much. The disc is a polygon of 96 corners with the area of the disc, whose outline is off by
/// a share of (2 pi / 96)^2 / 12 = 4e-4 of its radius one way and the other, which cancels to its
/// square. The light is in closed form; floats keep 1e-5.
TEST(CylindricalIlluminance, OfADiscIsThatOfTheFormula) {
  constexpr int corners = 96;
  constexpr double radius = 1.5, height = 2.0;
  const double outer = radius * std::sqrt(2.0 * pi / (corners * std::sin(2.0 * pi / corners)));
  std::vector<Eigen::Vector3d> outline;
  for (int i = 0; i < corners; ++i) {
    const double angle = -2.0 * pi * i / corners;
    outline.emplace_back(outer * std::cos(angle), outer * std::sin(angle), 1.2 + height);
  }
  const TracedScene lit(small_floor().polygon(panel, outline).build());
  const double t = std::atan2(radius, height);
  const double expected = radiance * (t - std::sin(t) * std::cos(t));
  for (const GridQuantity quantity : {GridQuantity::cylindrical, GridQuantity::semicylindrical}) {
    const LuxField field = measure_one(lit, quantity);
    EXPECT_NEAR(field.mean, expected, 2e-5 * expected);
    EXPECT_GE(field.lux_within[0], std::abs(field.mean - expected));
  }
}

/// A small lamp at the angle b from straight up, and a from the direction that half a cylinder
/// faces: E_z = I sin b / (pi d^2), E_sz = E_z (1 + cos a). The lamp of 2 cm at 2 m is a point to
/// (0.01 / 2)^2 = 2.5e-5. The planes leave (pi / n)^2 / 12 of E_z, and (pi / n)^2 / 8 for half.
TEST(CylindricalIlluminance, OfASmallLampIsThatOfTheFormulaWithinItsBound) {
  constexpr double half_width = 0.01, distance = 2.0, b = 0.9, point = 2.5e-5;
  const double intensity = radiance * 4.0 * half_width * half_width;
  const double step = pi / planes_of_a_cylinder;
  double worst = 0.0;
  for (const double a : {0.0, 0.03, 0.1, 0.5, 1.0, 1.6, 2.0, 3.0}) {
    const Eigen::Vector3d towards(std::sin(b) * std::cos(a), std::sin(b) * std::sin(a),
                                  std::cos(b));
    const Eigen::Vector3d eye(0, 0, 1.2);
    const TracedScene lit(
        small_floor().square(panel, eye + distance * towards, -towards, half_width).build());
    const double expected = intensity * std::sin(b) / (pi * distance * distance);
    const LuxField whole = measure_one(lit, GridQuantity::cylindrical);
    const LuxField part = measure_one(lit, GridQuantity::semicylindrical);
    const double round = whole.mean, half = part.mean;
    EXPECT_LE(std::abs(round - expected), whole.lux_within[0] + point * expected) << a;
    EXPECT_LE(std::abs(half - (1.0 + std::cos(a)) * expected),
              part.lux_within[0] + 2.0 * point * expected)
        << a;
    EXPECT_NEAR(round, expected, (step * step / 12.0 + point) * expected) << a;
    EXPECT_NEAR(half, (1.0 + std::cos(a)) * expected, (step * step / 8.0 + 2.0 * point) * expected)
        << a;
    worst = std::max(worst, std::abs(round / expected - 1.0));
  }
  EXPECT_GT(worst, 1e-4) << "the bound is there for a reason";
}

/// In a room of even light every plane gets M, and so do cylinders.
TEST(CylindricalIlluminance, InEvenLightIsThatOfAnyPlane) {
  const TracedScene lit(
      SceneBuilder()
          .box({.exitance = 10.0f, .one_sided = true}, {-1, -1, 0}, {1, 1, 2}, true)
          .build());
  LuxGrid grid = lux_grid(lit.scene, 0, up, {.height = 1.0, .margin = 0.5, .spacing = 2.0});
  measure_as(GridQuantity::cylindrical, up, Eigen::Vector3d::Zero(), grid);
  const LuxField field =
      measure_grid(lit.scene, lit.caster, lit.direct_light, lit.solution, grid, 1.0, {.rays = 64});
  EXPECT_NEAR(field.mean, pi * radiance, 1e-4 * pi * radiance);
}

TEST(VerticalIlluminance, IsThatOfTheDirection) {
  constexpr double half_width = 0.01, distance = 2.0;
  const TracedScene lit(
      small_floor()
          .square(panel, {distance, 0, 1.2}, -Eigen::Vector3d::UnitX(), half_width)
          .build());
  const double facing_it = 4.0 * half_width * half_width * radiance / (distance * distance);
  const Eigen::Vector3d aside(std::cos(1.0), std::sin(1.0), 0.7);  // the slope does not matter
  EXPECT_NEAR(measure_one(lit, GridQuantity::vertical).mean, facing_it, 1e-4 * facing_it);
  EXPECT_NEAR(measure_one(lit, GridQuantity::vertical, aside).mean, std::cos(1.0) * facing_it,
              1e-4 * facing_it);
  EXPECT_EQ(measure_one(lit, GridQuantity::vertical, -Eigen::Vector3d::UnitX()).mean, 0.0);
}

TEST(VerticalIlluminance, CannotFaceUpwards) {
  LuxGrid grid = lux_grid(small_floor().build(), 0, up, {.height = 1.2});
  EXPECT_NE(message_of<InputError>([&] {
              measure_as(GridQuantity::vertical, up, up, grid);
            }).find("faces straight up or down"),
            std::string::npos);
}

}  // namespace
}  // namespace lightwell::cylinder_test
