#include "daylight/daylight_glare.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

#include "raytrace/readings/glare.h"
#include "tests/daylight/daylight_rooms.h"

namespace lightwell::daylight_glare_test {
namespace {

using Eigen::Vector3d;
using std::numbers::pi;

Camera eye_towards(const Vector3d& position, const Vector3d& direction) {
  return {.name = "eye", .position = position, .direction = direction, .up = Vector3d::UnitZ()};
}

DaylightModel direct_model(const Scene& scene) {
  DaylightOptions options{.sky_subdivision = 2, .direct_only = true};
  options.mesh.auto_patch_count = 100;
  return {scene, Vector3d::UnitZ(), Vector3d::UnitY(), options};
}

// A small black slab far below the eye: nothing is in its way.
Scene open_ground() {
  Scene scene;
  const int black = test::add_material(scene, test::diffuse(scene.bands, 0.0f));
  test::add_polygon(scene, "slab", black,
                    {{0.0, 0.0, -90.0}, {0.1, 0.0, -90.0}, {0.1, 0.1, -90.0}, {0.0, 0.1, -90.0}});
  return scene;
}

// Sky hours of even luminance: without gradation.
SkyHour even_sky(double luminance) {
  return {
      .number = 12, .sun = Vector3d::UnitZ(), .altitude_degrees = 90.0, .dome_lux = pi * luminance};
}

}  // namespace

// 1000 lx without sources give 0.0587 + 0.16. Sources of 99 Ev^1.87 add 9.18e-2 log10 100.
TEST(DaylightGlare, FormulasAreThoseOfThePapers) {
  EXPECT_NEAR(daylight_glare_probability(1000.0, 0.0), 0.2187, 1e-12);
  EXPECT_NEAR(daylight_glare_probability(1000.0, 99.0 * std::pow(1000.0, 1.87)), 0.4023, 1e-12);
  EXPECT_EQ(daylight_glare_probability(1e6, 0.0), 1.0);
  EXPECT_EQ(daylight_glare_probability(0.0, 1e9), 0.0);
  EXPECT_NEAR(simplified_glare_probability(1000.0), 0.2462, 1e-12);
  EXPECT_EQ(simplified_glare_probability(0.0), 0.0);
}

// The sun in the line of sight has P = 1: E = L w gives L^2 w = E^2 / w, and w = pi (0.2665
// degrees)^2 to 1e-5. At 45 degrees above the line of sight E = L w cos 45.
TEST(DaylightGlare, SunIsADiscOfItsLuminance) {
  const Camera eye = eye_towards(Vector3d::Zero(), -Vector3d::UnitY());
  const double half = 0.2665 * pi / 180.0, w = pi * half * half;
  SkyHour hour{.sun = -Vector3d::UnitY(), .sun_lux = 1e5};
  EXPECT_NEAR(sun_contrast(eye, hour, 5e4), 2.5e9 / w, 1e-5 * 2.5e9 / w);
  hour.sun = Vector3d(0.0, -1.0, 1.0).normalized();
  const double P = position_index(45.0, 0.0), L = 5e4 / (std::sqrt(0.5) * w);
  EXPECT_NEAR(sun_contrast(eye, hour, 5e4), L * L * w / (P * P), 1e-5 * L * L * w / (P * P));
  hour.sun = Vector3d::UnitY();
  EXPECT_EQ(sun_contrast(eye, hour, 5e4), 0.0);
}

// An eye that the sun grazes has light of the part of the disc ahead, and the middle of the disc
// next to no cosine. L is that of the sun in the open, and w that of the whole disc. P is 16, where
// its formula gives 82 at 85 degrees and more beyond.
TEST(DaylightGlare, GrazingSunIsNoBrighterThanTheSun) {
  const Camera eye = eye_towards(Vector3d::Zero(), -Vector3d::UnitY());
  const double half = 0.2665 * pi / 180.0, w = pi * half * half;
  constexpr double sun_lux = 1e5;
  const double most = sun_lux * sun_lux / w / (16.0 * 16.0);
  for (const double degrees : {85.0, 89.9, 89.9999}) {
    const double angle = degrees * pi / 180.0;
    const SkyHour hour{.sun = Vector3d(0.0, -std::cos(angle), std::sin(angle)), .sun_lux = sun_lux};
    // A disc whose middle is on the eye's horizon gives 4 / (3 pi) of its radius as the cosine.
    const double sunlight = sun_lux * std::max(std::cos(angle), 4.0 / (3.0 * pi) * half);
    EXPECT_NEAR(sun_contrast(eye, hour, sunlight), most, 1e-5 * most) << degrees;
  }
}

// Above an eye, 80 degrees and more from its direction, the formula gives P = 45 and more. P is 16
// there, so that the weight of a patch of sky is its solid angle over 16^2.
TEST(DaylightGlare, PositionIndexIsAtMost16) {
  const DaylightModel model = direct_model(open_ground());
  const Camera eye = eye_towards(Vector3d::Zero(), Vector3d::UnitY());
  const GlareView view = glare_view(model, eye);
  const SkyPatches& sky = model.sky();
  int edge = 0;
  for (int c = 0; c < sky.dome_count(); ++c) {
    const double weight = double{view.weight[sky.column_of(c)]};
    if (!(weight > 0.0)) continue;
    const Vector3d middle = sky.direction(c, 0.5, 0.5);
    const double sigma = std::acos(middle.dot(eye.direction)) * 180.0 / pi;
    // Patches are 6.2 degrees high; those with their middle within 84 degrees are seen whole.
    if (sigma > 84.0 || sigma < 80.0 || middle.z() < 0.9) continue;
    ++edge;
    // Floats of sums of 9 doubles.
    EXPECT_NEAR(weight, sky.solid_angle(c) / 256.0, 1e-6 * weight) << c;
  }
  EXPECT_GT(edge, 0);
}

// A veil that passes half of the light leaves a quarter of L^2.
TEST(DaylightGlare, PanesDimSources) {
  Scene room = test::room_with_panes(1);
  const Camera eye = eye_towards({2.0, 1.5, 1.2}, -Vector3d::UnitY());
  const GlareView hole = glare_view(direct_model(room), eye);
  for (Material& material : room.materials) {
    if (material.dielectric) material = test::veil(room.bands, 0.5f);
  }
  const GlareView dimmed = glare_view(direct_model(room), eye);
  EXPECT_GT(hole.weight.sum(), 0.0f);
  // Floats of a tint of exactly one half.
  EXPECT_TRUE((dimmed.weight == 0.25f * hole.weight).all());
  EXPECT_TRUE((dimmed.transmittance == 0.5f * hole.transmittance).all());
}

// The window of 2 m x 1 m at 1.5 m, seen from straight before its middle, has the solid angle 4
// asin(a b / sqrt((a^2 + d^2) (b^2 + d^2))) for half sides a and b. In the middle of the field P is
// above 1, so the weight is below the solid angle; towards the window's edge P reaches that of its
// corners.
TEST(DaylightGlare, WeightIsTheSolidAngleByThePositionIndex) {
  const Scene room = test::room_with_panes(1);
  const Camera eye = eye_towards({2.0, 1.5, 1.5}, -Vector3d::UnitY());
  const DaylightModel model = direct_model(room);
  const double a = 1.0, b = 0.5, d = 1.5;
  const double w = 4.0 * std::asin(a * b / std::sqrt((a * a + d * d) * (b * b + d * d)));
  const double weight = double{glare_view(model, eye, 6).weight.sum()};
  // The mean of 1 / P^2 over the window, by the midpoint rule on the window's plane.
  double mean = 0.0;
  constexpr int steps = 200;
  for (int i = 0; i < steps; ++i) {
    for (int j = 0; j < steps; ++j) {
      const double x = (2.0 * (i + 0.5) / steps - 1.0) * a, z = (2.0 * (j + 0.5) / steps - 1.0) * b;
      const double r = std::sqrt(x * x + z * z + d * d);
      const double P =
          position_index(std::acos(d / r) * 180.0 / pi, std::atan2(std::abs(x), z) * 180.0 / pi);
      mean += 4.0 * a * b / (steps * steps) * d / (r * r * r) / (P * P);
    }
  }
  EXPECT_LT(mean, w);
  // Rays are 36 in a cell of 577 each way; a cell on the edge, 7.8 degrees wide, is known to half
  // a ray's share of its width. The edge of 6 m crosses some 30 cells of 0.011 sr: an error of at
  // most 30 cells / 12 at random, sqrt(30) / 12 * 0.011 = 0.005 sr of 0.7 sr, four times over.
  EXPECT_NEAR(weight, mean, 4.0 * 0.005);
}

// Patches of an even sky are sources above glare_luminance alone.
TEST(DaylightGlare, OnlyBrightSkyIsASource) {
  const DaylightModel model = direct_model(open_ground());
  const Camera eye = eye_towards(Vector3d::Zero(), Vector3d::UnitY());
  const GlareView view = glare_view(model, eye);
  const std::vector<SkyHour> hours = {even_sky(1900.0), even_sky(2100.0)};
  const Eigen::ArrayXd contrast = sky_contrast(model, view, hours, 0.0);
  EXPECT_EQ(contrast[0], 0.0);
  // A luminance of 2100 cd/m^2 all over the dome; float sums of 577 columns.
  const double expected =
      2100.0 * 2100.0 * double{view.weight.head(model.sky().dome_count()).sum()};
  EXPECT_NEAR(contrast[1], expected, 1e-4 * expected);
}

// Ten hours are occupied, and DGP is 0.5 in one of them, 0.42 in one and 0.37 in one; in the
// evening nobody is there.
TEST(DaylightGlare, HoursAreCountedByClass) {
  GlareOfYear glare{.dgp = {0.5f, 0.42f, 0.37f, 0.9f}, .vertical_lux = {5000.0f, 1.0f, 1.0f, 1.0f}};
  const std::vector<SkyHour> hours = {{.number = 8}, {.number = 9}, {.number = 17}, {.number = 18}};
  count_glare(hours, {.from = 8, .to = 18}, 10, glare);
  EXPECT_DOUBLE_EQ(glare.above_45, 10.0);
  EXPECT_DOUBLE_EQ(glare.above_40, 20.0);
  EXPECT_DOUBLE_EQ(glare.above_35, 30.0);
  // 6.22e-5 * 5000 + 0.184 = 0.495.
  EXPECT_DOUBLE_EQ(glare.simplified_above_45, 10.0);
  EXPECT_EQ(glare.level, "none");
  count_glare(hours, {.from = 8, .to = 18}, 20, glare);
  EXPECT_EQ(glare.level, "minimum");
  count_glare(hours, {.from = 8, .to = 18}, 40, glare);
  EXPECT_EQ(glare.level, "medium");
  count_glare(hours, {.from = 8, .to = 18}, 60, glare);
  EXPECT_EQ(glare.level, "high");
}

}  // namespace lightwell::daylight_glare_test
