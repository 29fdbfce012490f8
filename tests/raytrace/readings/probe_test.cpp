#include "raytrace/readings/probe.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <string>

#include "radiosity/closed_forms/polygon_form_factor.h"
#include "radiosity/emitters/emitter.h"
#include "raytrace/readings/probe_surface.h"
#include "scene/errors.h"
#include "scene/io/read_scene.h"
#include "tests/raytrace/lit_scene.h"
#include "tests/temporary_folder.h"

namespace lightwell::probe_test {
namespace {

constexpr auto pi_f = std::numbers::pi_v<float>;
const Eigen::Vector3d up = Eigen::Vector3d::UnitZ();

BandArray interpolated(const TracedScene& lit, const std::vector<Probe>& probes) {
  return interpolate_irradiance(lit.caster, lit.solution, probes);
}
BandArray gathered(const TracedScene& lit, const std::vector<Probe>& probes, int rays = 256) {
  return probe_irradiance(lit.scene, lit.caster, lit.direct_light, lit.solution, probes,
                          {.rays = rays});
}

/// A closed room with a block on the floor; all surfaces emit M and reflect rho, E = M / (1 - rho).
constexpr float rho = 0.5f, M = 1.0f, B = M / (1.0f - rho);
const TracedScene& furnace() {
  static const auto lit = [] {
    const Paint paint{.reflectance = rho, .exitance = M, .one_sided = true};
    auto scene = std::make_unique<TracedScene>(SceneBuilder()
                                                   .box(paint, {0, 0, 0}, {2, 2, 2}, true)
                                                   .box(paint, {0.5, 0.5, 0}, {1, 1, 1}, false)
                                                   .build());
    scene->set_indirect([](const auto&) { return B; });
    return scene;
  }();
  return *lit;
}

// The hair by which probes in the air may lie within a body is 1e-5 of the diagonal, 35 um, and
// sqrt(2) times as much towards a corner.
TEST(ProbeIrradiance, DeeperWithinABlockIsDark) {
  for (const double depth : {5e-5, 1e-4, 1e-3, 0.1}) {
    const BandArray E = gathered(furnace(), {{{0.7, 1.0 - depth, 0.3}, up}});
    EXPECT_EQ(E(0, 0), 0.0f) << depth;
  }
}

// The floor lies out of reach (1e-4 of the diagonal, 0.35 mm) and the bottom of a block does not.
// Only roundings to float remain, as in FurnaceProbe.
TEST(ProbeIrradiance, AtABlockALittleAboveTheFloorIsNotWithinTheBlock) {
  const Paint paint{.reflectance = rho, .exitance = M, .one_sided = true};
  TracedScene lit(SceneBuilder()
                      .box(paint, {0, 0, 0}, {2, 2, 2}, true)
                      .box(paint, {0.5, 0.5, 1e-4}, {1, 1, 1}, false)
                      .build());
  lit.set_indirect([](const auto&) { return B; });
  EXPECT_NEAR(gathered(lit, {{{0.7, 0.99999, 4e-4}, up}})(0, 0), B, 1e-4 * B);
}

/// The place at which a probe that looks up gathers light, along x from (0, 1, 1).
double x_of_point(const TracedScene& lit, double x) {
  const std::vector<Probe> probes = {{{x, 1, 1}, up}};
  return probe_points(lit.caster, probes).front().position.x();
}

// Diagonals are below 4.2 m and a hair thus below 42 um. Positions are rounded to 2^-24 of some
// metres, which is less than 1 um.
TEST(ProbeSurface, KeepsTheSideOfASheetBetweenRoomsButNotThatWithinASheetOfABody) {
  const Paint paint{.reflectance = rho, .exitance = M};
  const TracedScene rooms(SceneBuilder()
                              .box(paint, {-1, 0, 0}, {1, 2, 2}, true)
                              .polygon(paint, {{0, 0, 0}, {0, 2, 0}, {0, 2, 2}, {0, 0, 2}})
                              .build());
  const TracedScene body(SceneBuilder()
                             .box(paint, {-2, 0, 0}, {1, 2, 2}, true)
                             .box(paint, {-1, 0.5, 0.5}, {0, 1.5, 1.5}, false)
                             .build());
  EXPECT_GT(x_of_point(rooms, 5e-6), 1e-5);
  EXPECT_LT(x_of_point(rooms, -5e-6), -1e-5);
  EXPECT_GT(x_of_point(body, 5e-6), 1e-5);
  EXPECT_GT(x_of_point(body, -5e-6), 1e-5);
  EXPECT_EQ(x_of_point(body, -1e-3), -1e-3);
  EXPECT_EQ(x_of_point(body, 1e-4), 1e-4);
}

TEST(ProbeSurface, KeepsToTheMiddleOfAGapThinnerThanItsHair) {
  const Paint paint{.reflectance = rho, .exitance = M, .one_sided = true};
  const double gap = 2e-5;
  const TracedScene lit(SceneBuilder()
                            .box(paint, {-1, 0, 0}, {0, 2, 2}, false)
                            .box(paint, {gap, 0, 0}, {1, 2, 2}, false)
                            .build());
  for (const double x : {-5e-6, 1e-6, 1.9e-5, 2.5e-5}) {
    EXPECT_NEAR(x_of_point(lit, x), 0.5 * gap, 1e-6) << x;
  }
}

// The reach of a surface is 1e-4 of the diagonal, 2 sqrt(3) m, and probes are named up to ten times
// as far behind it.
TEST(ProbeSurface, NamesProbesJustBehindSurfaces) {
  const std::vector<Probe> probes = {{{1.5, 1.5, 0.0}, up},    {{1.5, 1.5, -3e-4}, up},
                                     {{1.5, 1.5, -1e-3}, up},  {{1.5, 1.5, -3e-3}, up},
                                     {{1.5, 1.5, -5e-3}, up},  {{1.5, 1.5, 1e-3}, up},
                                     {{1.5, 1.5, -1e-3}, -up}, {{0.7, 0.7, 0.999}, up},
                                     {{0.7, 0.7, 1.001}, up},  {{1.5, 1.5, 1.0}, up}};
  EXPECT_EQ(probes_behind_surfaces(furnace().caster, probes), (std::vector<int>{2, 3, 7}));
}

// A facet 10 km away, whose share of the diagonal is a metre, takes no desk for the floor below.
TEST(ProbeSurface, ReachesNoFurtherForAFarFacet) {
  const Paint paint{.reflectance = rho, .exitance = M, .one_sided = true};
  TracedScene lit(SceneBuilder()
                      .box(paint, {0, 0, 0}, {2, 2, 2}, true)
                      .polygon(paint, {{10000, 0, 0}, {10000, 1, 0}, {10000, 0, 1}})
                      .build());
  lit.set_indirect([](const auto&) { return B; });
  EXPECT_THROW(interpolated(lit, {{{1.0, 1.0, 0.7}, up}}), InputError);
  EXPECT_NO_THROW(interpolated(lit, {{{1.0, 1.0, 0.01}, up}}));
}

struct NamedProbe {
  const char* name;
  Probe probe;
};
class FurnaceProbe : public ::testing::TestWithParam<NamedProbe> {};

TEST_P(FurnaceProbe, SeesTheSameLightEverywhere) {
  // In a closed room every ray ends on radiosity B, so the gather has no noise but float rounding.
  const std::vector<Probe> probes = {GetParam().probe};
  EXPECT_NEAR(gathered(furnace(), probes)(0, 0), B, 1e-4 * B);
}

INSTANTIATE_TEST_SUITE_P(
    Places, FurnaceProbe,
    ::testing::Values(NamedProbe{"floor", {{1.5, 1.5, 0}, {0, 0, 1}}},
                      NamedProbe{"little_above_floor", {{1.5, 1.5, 1e-5}, {0, 0, 1}}},
                      NamedProbe{"little_below_floor", {{1.5, 1.5, -1e-5}, {0, 0, 1}}},
                      NamedProbe{"ceiling", {{0.3, 0.3, 2}, {0, 0, -1}}},
                      NamedProbe{"free", {{1.5, 1.5, 1}, {0, 0.6, 0.8}}},
                      NamedProbe{"floor_at_wall", {{0, 1.3, 0}, {0, 0, 1}}},
                      NamedProbe{"wall_at_floor", {{2, 1.3, 0}, {-1, 0, 0}}},
                      NamedProbe{"corner", {{0, 0, 0}, {0, 0, 1}}},
                      NamedProbe{"floor_at_block", {{0.5, 0.7, 0}, {0, 0, 1}}},
                      NamedProbe{"block_edge", {{0.5, 0.7, 1}, {0, 0, 1}}},
                      NamedProbe{"block_side_at_edge", {{0.5, 0.7, 1}, {-1, 0, 0}}},
                      NamedProbe{"air_at_block_side", {{0.7, 1.0, 0.3}, {0, 0, 1}}},
                      NamedProbe{"air_a_little_within_block", {{0.7, 0.99999, 0.3}, {0, 0, 1}}},
                      NamedProbe{"air_within_block_edge", {{0.99999, 0.99999, 0.3}, {0, 0, 1}}},
                      NamedProbe{"air_at_wall", {{2, 1.3, 0.3}, {0, 0, 1}}},
                      NamedProbe{"air_a_little_behind_wall", {{2.00001, 1.3, 0.3}, {0, 0, 1}}},
                      NamedProbe{"air_behind_corner", {{2.00001, 2.00001, 0.3}, {0, 0, 1}}}),
    [](const auto& place) { return place.param.name; });

TEST(InterpolateIrradiance, IsExactForALinearField) {
  TracedScene lit(SceneBuilder()
                      .polygon({.reflectance = 0.5f}, {{0, 0, 1}, {2, 0, 1}, {2, 1, 1}, {0, 1, 1}})
                      .build());
  const auto E = [](const Eigen::Vector3d& p) { return static_cast<float>(3 + p.x() - p.y()); };
  lit.set_indirect(E);
  std::vector<Probe> probes;
  for (const double x : {0.0, 0.13, 0.77, 1.99, 2.0}) {
    for (const double y : {0.0, 0.41, 1.0}) probes.push_back({{x, y, 1}, up});
  }
  const BandArray values = interpolated(lit, probes);
  // A probe on the rim is moved inwards by at most 1e-5 of the diagonal.
  for (std::size_t i = 0; i < probes.size(); ++i) {
    EXPECT_NEAR(values(static_cast<Eigen::Index>(i), 2), E(probes[i].position), 1e-4);
  }
}

TEST(InterpolateIrradiance, TellsTheSidesOfAWallApart) {
  TracedScene lit(SceneBuilder().square({.reflectance = 0.5f}, {0, 0, 0}, up, 1).build());
  for (int v = 0; v < lit.mesh.vertex_count(); ++v) {
    lit.solution.direct_irradiance.row(v) = lit.mesh.vertex_normal[v].z() > 0 ? 5.0f : 1.0f;
  }
  const BandArray E = interpolated(lit, {{{0.1, 0.2, 0}, up}, {{0.1, 0.2, 0}, -up}});
  EXPECT_FLOAT_EQ(E(0, 0), 5.0f);
  EXPECT_FLOAT_EQ(E(1, 0), 1.0f);
}

TEST(InterpolateIrradiance, ProbeOffEverySurfaceIsNamedInFileUnits) {
  TracedScene lit(
      SceneBuilder().square({.reflectance = 0.5f, .one_sided = true}, {0, 0, 0}, up, 1).build());
  lit.solution.metres_per_unit = 1e-3;
  lit.solution.unit_name = "mm";
  const auto refusal = [&](const Probe& probe) {
    return message_of<InputError>([&] { interpolated(lit, {{{0, 0, 0}, up}, probe}); });
  };
  // With a scene diagonal of 2.83 m, a probe 0.1 m off the surface is refused, one 0.1 mm off is
  // not.
  EXPECT_TRUE(says(refusal({{0.5, 0.25, 0.1}, up}), "probe 2 at (500, 250, 100) mm lies on no"));
  EXPECT_EQ(refusal({{0.5, 0.25, 1e-4}, up}), "");
  EXPECT_TRUE(says(refusal({{0.5, 0.25, 0}, Eigen::Vector3d::UnitX()}), "lies on no surface"));
  EXPECT_TRUE(says(refusal({{0.5, 0.25, 0}, -up}), "back of a one-sided surface"));
}

TEST(ProbeIrradiance, UnderASmallLampIsTheClosedForm) {
  // The form factor of a parallel square lamp of half width a at height h above the probe is that
  // of four corner rectangles (Howell, A catalog of radiation heat transfer configuration factors,
  // B-4).
  constexpr double a = 0.5, h = 2.0;
  const double X = a / h, root = std::sqrt(1 + X * X);
  const double F = 4.0 / (2 * std::numbers::pi) * 2 * (X / root) * std::atan(X / root);
  const TracedScene lit(SceneBuilder()
                            .square({.reflectance = 0.5f, .one_sided = true}, {0, 0, 0}, up, 5)
                            .square({.exitance = 7.0f, .one_sided = true}, {0, 0, h}, -up, a)
                            .build());
  ASSERT_EQ(lit.direct_light.emitters().size(), 1u);
  const BandArray E = gathered(lit, {{{0, 0, 0}, up}, {{0, 0, 1e-4}, up}, {{0, 0, 0}, -up}});
  EXPECT_NEAR(E(0, 0), 7.0 * F, 1e-5 * 7.0 * F);
  EXPECT_NEAR(E(1, 0), 7.0 * F, 1e-3 * 7.0 * F);  // on the floor, 1e-4 m above it or not
  EXPECT_EQ(E(2, 0), 0.0f);
}

// A square lamp above a wide mirror; surfaces reflect no light diffusely, so a gather that faces
// the mirror finds none.
TEST(ProbeIrradiance, OfMirroredLightAloneHasABound) {
  constexpr float exitance = 10.0f, specular = 0.8f;
  const Eigen::Vector3d at(0.3, 0.2, 1.0);
  const TracedScene lit(
      SceneBuilder()
          .square({.specular = specular, .one_sided = true}, {0, 0, 0}, up, 20.0)
          .square({.exitance = exitance, .one_sided = true}, {0, 0.5, 2}, -up, 0.5)
          .build());
  ProbeBounds bounds;
  const std::vector<Probe> probes = {{at, -up}, {{0, 0.5, 3}, up}};
  const BandArray E = probe_irradiance(lit.scene, lit.caster, lit.direct_light, lit.solution,
                                       probes, {.rays = 256}, &bounds);
  const Loop image = {{-0.5, 0, -2}, {0.5, 0, -2}, {0.5, 1, -2}, {-0.5, 1, -2}};
  const double expected = specular * exitance * std::abs(point_to_polygon(at, -up, image));
  const double lux_of_one = luminous(lit.scene.bands, Spectrum::Ones(E.cols()));
  EXPECT_GT(bounds.lux_within[0], 0.0);
  // The bound is two standard errors, and the test allows four.
  EXPECT_NEAR(lux_of_one * E(0, 0), lux_of_one * expected, 2.0 * bounds.lux_within[0]);
  // Of 4096 + 32 * 256 cosine-distributed rays, the form factor 0.034 of the lamp's image would
  // meet it: two standard errors of 2 sqrt(0.966 / (0.034 * 12288)) = 9.6 %.
  EXPECT_LT(bounds.lux_within[0], 0.1 * lux_of_one * expected);
  // Nothing is known behind the lamp, where there is no light.
  EXPECT_EQ(E(1, 0), 0.0f);
  EXPECT_TRUE(std::isnan(bounds.lux_within[1]));
}

TEST(ProbeIrradiance, OnTheFoldOfABentFloorIsShadedByNeitherHalf) {
  // Two triangles of a quadrilateral that deviates from a plane by 2 mm meet along the diagonal.
  TracedScene lit(SceneBuilder()
                      .polygon({.reflectance = 0.5f, .one_sided = true},
                               {{-1, -1, 0}, {1, -1, 2e-3}, {1, 1, 0}})
                      .polygon({.reflectance = 0.5f, .one_sided = true},
                               {{-1, -1, 0}, {1, 1, 0}, {-1, 1, 2e-3}})
                      .square({.exitance = 7.0f, .one_sided = true}, {0, 0, 2}, -up, 0.2)
                      .build());
  ASSERT_EQ(lit.direct_light.emitters().size(), 1u);
  const BandArray E = gathered(lit, {{{0.1, 0.1, 0}, up}, {{0.11, 0.09, 1e-5}, up}});
  EXPECT_GT(E(1, 0), 0.0f);
  EXPECT_NEAR(E(0, 0), E(1, 0), 0.01 * E(1, 0));  // 14 mm apart under a lamp 2 m up
}

TEST(ProbeIrradiance, BelowAStackOfTwoFloorsSeesNeither) {
  // Two sheets lie in one plane. The caster may hit either; the other must not shade the probe.
  TracedScene lit(SceneBuilder()
                      .square({.reflectance = 0.5f, .one_sided = true}, {0, 0, 0}, up, 1)
                      .square({.reflectance = 0.5f, .one_sided = true}, {0, 0, 0}, up, 0.5)
                      .square({.exitance = pi_f}, {0, 0, 1}, -up, 100)
                      .build());
  const BandArray E = gathered(lit, {{{0.1, 0.2, 0}, up}}, 1024);
  EXPECT_NEAR(E(0, 0), pi_f, 1e-3 * pi_f);  // the lamp fills the hemisphere to (1/100)^2
}

/// Illuminance at a point of the floor of a scene file, lx.
double lux_at(const std::string& text, const Eigen::Vector3d& position) {
  const TemporaryFolder folder;
  const Scene scene = read_scene(folder.write("scene.toml", text));
  const SolvedScene solved = solve_scene(scene, options_for_probes());
  const ElementCaster caster(solved.mesh);
  const DirectLight direct_light(scene, solved.mesh);
  const std::array<Probe, 1> probe{Probe{position, up}};
  const BandArray E =
      probe_irradiance(scene, caster, direct_light, solved.solution, probe, {.rays = 64});
  return luminous(scene.bands, E.row(0).transpose());
}

/// E under the middle of a square panel of even luminance L, side a and height h:
/// 4 L (s / r) atan(s / r) with s = a / 2 and r^2 = s^2 + h^2. In a closed room that emits M
/// everywhere, E = M / (1 - rho). Direct light is a closed form, and the room's light is the same
/// in every direction; what remains is rounding to float.
TEST(ProbeIrradiance, LightGivenAsPeopleSeeItIsLux) {
  const std::string panel = R"(
[materials.dark]
[materials.panel]
)";
  const std::string geometry = R"(
[[surfaces]]
material = "panel"
polygon = [[-0.5, -0.5, 2], [-0.5, 0.5, 2], [0.5, 0.5, 2], [0.5, -0.5, 2]]
[[surfaces]]
material = "dark"
polygon = [[-1, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]]
)";
  const double r = std::sqrt(0.25 + 4.0), of_unit = 4.0 * (0.5 / r) * std::atan(0.5 / r);
  for (const std::string bands :
       {"", "[bands]\nlumens_per_watt = 179\n", "[bands]\nkind = \"spectral\"\ncount = 5\n"}) {
    const std::string head = bands + panel;
    const double under_1000 = lux_at(head + "luminance = 1000\n" + geometry, {0, 0, 0});
    EXPECT_NEAR(under_1000, 1000.0 * of_unit, 1e-4 * under_1000) << bands;
    // An area of 1 m^2 that emits pi lm has L = 1.
    const std::string pi_lumens = std::to_string(std::numbers::pi);
    for (const std::string key : {"lumens", "luminous_exitance"}) {
      const double lux = lux_at(head + key + " = " + pi_lumens + "\n" + geometry, {0, 0, 0});
      EXPECT_NEAR(lux, of_unit, 1e-4 * of_unit) << key;
    }
    const std::string closed = R"(
[materials.wall]
reflectance = 0.5
luminous_exitance = 100
[[surfaces]]
material = "wall"
box = { min = [0, 0, 0], max = [2, 2, 2], inward = true }
)";
    EXPECT_NEAR(lux_at(bands + closed, {0.7, 0.4, 0}), 200.0, 0.02) << bands;
  }
}

}  // namespace
}  // namespace lightwell::probe_test
