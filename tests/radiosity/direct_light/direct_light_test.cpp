#include "radiosity/direct_light/direct_light.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>

#include "mesh/build_patches.h"
#include "radiosity/closed_forms/polygon_form_factor.h"
#include "radiosity/emitters/emitter.h"
#include "tests/radiosity/test_scenes.h"

namespace lightwell::direct_light_test {
namespace {

Loop loop(const nlohmann::json& j) {
  Loop points;
  for (const auto& p : j)
    points.emplace_back(p[0].get<double>(), p[1].get<double>(), p[2].get<double>());
  return points;
}

struct LitFloor {
  Scene scene;
  PatchMesh mesh;
  int floor_facet = 0;
};

// polygon1 receives, polygon2 emits, blockers are black. A far wall keeps the emitter a small part
// of the scene.
LitFloor occluded_case(const nlohmann::json& g) {
  LitFloor s;
  const int black = test::add_material(s.scene, test::diffuse(s.scene.bands, 0.0f));
  const int lamp = test::add_material(s.scene, test::diffuse(s.scene.bands, 0.0f, 1.0f));
  test::add_polygon(s.scene, "receiver", black, loop(g["polygon1"]));
  test::add_polygon(s.scene, "emitter", lamp, loop(g["polygon2"]));
  for (const auto& b : g["blockers"]) {
    if (b.contains("polygon")) {
      Material both = test::diffuse(s.scene.bands, 0.0f);
      both.one_sided = false;
      test::add_polygon(s.scene, "blocker", test::add_material(s.scene, both), loop(b["polygon"]));
    } else {
      const Loop corners = loop(b["box"]);
      test::add_box(s.scene, corners[0], corners[1], {black, black, black, black, black, black},
                    false);
    }
  }
  test::add_polygon(s.scene, "far", black, {{-9, -9, -9}, {9, -9, -9}, {9, 9, -9}, {-9, 9, -9}});
  s.mesh = build_patches(s.scene, {.max_patch_size = 0.5, .elements_per_patch_edge = 1});
  return s;
}

TEST(DirectLight, OccludedFormFactorsAreExactInTheMean) {
  std::ifstream file(LIGHTWELL_TEST_DATA "/analytic/viewfactors.json");
  int tested = 0;
  for (const auto& c : nlohmann::json::parse(file)) {
    if (c["kind"] != "occluded") continue;
    const LitFloor s = occluded_case(c["geometry"]);
    const ElementCaster caster(s.mesh);
    const DirectLight direct_light(s.scene, s.mesh);
    ASSERT_EQ(direct_light.emitters().size(), 1u);

    const Loop receiver = loop(c["geometry"]["polygon1"]);
    const Eigen::Vector3d u = receiver[1] - receiver[0], v = receiver.back() - receiver[0];
    const Eigen::Vector3d n = u.cross(v).normalized();
    constexpr int points = 4096;
    const SobolPoints sobol(points);
    double sum = 0.0, sum2 = 0.0;
    for (int i = 0; i < points; ++i) {
      const Eigen::Array4f at = sobol.point(i, 7);
      const Eigen::Vector3d p = receiver[0] + at[0] * u + at[1] * v;
      const double F = direct_light.form_factor(
          direct_light.emitters()[0], caster,
          {.at = {p, n, 0}, .key = random_key(i), .shadows = {.min_rays = 64, .max_rays = 64}});
      sum += F;
      sum2 += F * F;
    }
    const double mean = sum / points;
    // The error of independent points is an upper bound for a scrambled Sobol mean.
    const double se = std::sqrt(std::max(0.0, sum2 / points - mean * mean) / points);
    const double exact = c["value"];
    std::printf("%s: F %.6f exact %.6f difference %.1e (standard error < %.1e)\n",
                c["id"].get<std::string>().c_str(), mean, exact, mean - exact, se);
    if (c["id"] == "occ-square-unit-blocker") {
      EXPECT_EQ(mean,
                0.0);  // nothing passes beside a blocker of the same size seen from inside its rim
    } else {
      EXPECT_NEAR(mean, exact, 4 * se + 1e-9) << c["id"];
    }
    ++tested;
  }
  EXPECT_GE(tested, 6);
}

// A lamp in an empty room: E = M F with no noise at all, for any number of shadow rays.
TEST(DirectLight, UnoccludedIrradianceIsTheClosedForm) {
  Scene scene;
  const int wall = test::add_material(scene, test::diffuse(scene.bands, 0.5f));
  const int lamp = test::add_material(scene, test::diffuse(scene.bands, 0.0f, 3.0f));
  test::add_box(scene, {0, 0, 0}, {2, 2, 2}, {wall, wall, wall, wall, wall, wall}, true);
  const Loop points = {{0.8, 0.8, 1.9}, {0.8, 1.2, 1.9}, {1.2, 1.2, 1.9}, {1.2, 0.8, 1.9}};
  test::add_polygon(scene, "lamp", lamp, points);
  const PatchMesh mesh = build_patches(scene, {.max_patch_size = 0.5});
  const ElementCaster caster(mesh);
  const DirectLight direct_light(scene, mesh);
  EXPECT_TRUE(direct_light.owns(6, false));
  EXPECT_FALSE(direct_light.owns(0, false));
  for (int i = 0; i < 50; ++i) {
    const Eigen::Vector3d p(2 * random_uniform(2 * i), 2 * random_uniform(2 * i + 1), 0.0);
    const Eigen::Vector3d n(0, 0, 1);
    const double exact = 3.0 * std::abs(point_to_polygon(p, n, {&points, 1}));
    const Spectrum E = direct_light.irradiance(caster, {.at = {p, n, 4}, .key = random_key(i)});
    EXPECT_NEAR(E[0], exact, 1e-6 * exact);  // float spectrum
  }
  // The lamp's back and the ceiling above it get nothing from it.
  EXPECT_EQ(direct_light.irradiance(caster, {.at = {{1.0, 1.0, 2.0}, {0, 0, -1}, 5}, .key = 1})[0],
            0.0f);
}

// A luminous ceiling is half of all area here. Nothing hides it, so the closed form is exact.
TEST(DirectLight, OfASingleLargeEmitterIsTheClosedForm) {
  Scene scene;
  const int black = test::add_material(scene, test::diffuse(scene.bands, 0.0f));
  const int glow = test::add_material(scene, test::diffuse(scene.bands, 0.0f, 3.0f));
  const Loop ceiling = {{0, 0, 2}, {0, 3, 2}, {4, 3, 2}, {4, 0, 2}};
  test::add_polygon(scene, "floor", black, {{0, 0, 0}, {4, 0, 0}, {4, 3, 0}, {0, 3, 0}});
  test::add_polygon(scene, "ceiling", glow, ceiling);
  // A small dim lamp behind the bright ceiling keeps its closed form, too.
  test::add_polygon(scene, "lamp",
                    test::add_material(scene, test::diffuse(scene.bands, 0.0f, 1.0f)),
                    {{1, 1, 1}, {1, 1.1, 1}, {1.1, 1.1, 1}, {1.1, 1, 1}});
  const PatchMesh mesh = build_patches(scene, {.max_patch_size = 1.0});
  const ElementCaster caster(mesh);
  const DirectLight light(scene, mesh);
  ASSERT_EQ(light.emitters().size(), 2u);
  EXPECT_TRUE(light.owns(1, false));
  const Eigen::Vector3d p(3.7, 2.6, 0.0), n(0, 0, 1);
  const Loop lamp = {{1, 1, 1}, {1, 1.1, 1}, {1.1, 1.1, 1}, {1.1, 1, 1}};
  const double exact = 3.0 * std::abs(point_to_polygon(p, n, {&ceiling, 1})) +
                       std::abs(point_to_polygon(p, n, {&lamp, 1}));
  // The lamp hides less than 1e-3 of the ceiling, whose light it replaces by a third.
  EXPECT_NEAR(light.irradiance(caster, {.at = {p, n, 0}, .key = 1})[0], exact, 2e-3 * exact);
}

TEST(DirectLight, ManyLargeEmittersAreLeftToTheHemisphereOfRays) {
  const Scene scene = test::furnace(0.5f, 1.0f, false);
  const PatchMesh mesh = build_patches(scene, {.max_patch_size = 0.5});
  EXPECT_TRUE(DirectLight(scene, mesh).emitters().empty());
}

TEST(DirectLight, SphereLampObeysTheClosedForm) {
  Scene scene;
  const int wall = test::add_material(scene, test::diffuse(scene.bands, 0.5f));
  const int lamp = test::add_material(scene, test::diffuse(scene.bands, 0.0f, 2.0f));
  test::add_box(scene, {0, 0, 0}, {2, 2, 2}, {wall, wall, wall, wall, wall, wall}, true);
  const Sphere ball{{1.0, 1.1, 1.2}, 0.2};
  scene.surfaces.push_back({.name = "ball", .material = lamp, .shape = ball});
  const PatchMesh mesh = build_patches(scene, {.max_patch_size = 0.5});
  const ElementCaster caster(mesh);
  const DirectLight direct_light(scene, mesh);
  for (int i = 0; i < 50; ++i) {
    const Eigen::Vector3d p(2 * random_uniform(2 * i), 0.0, 2 * random_uniform(2 * i + 1));
    const double exact = 2.0 * point_to_sphere(p, {0, 1, 0}, ball.center, ball.radius);
    EXPECT_NEAR(direct_light.irradiance(caster, {.at = {p, {0, 1, 0}, 2}, .key = random_key(i)})[1],
                exact, 1e-6 * exact);
  }
}

// Rounding, of a turn or of coordinates in single precision, puts a lamp in the plane of its
// ceiling a little before or behind the ceiling. The ceiling under the lamp is dark in either case.
TEST(DirectLight, LampsInTheirCeilingDoNotShineAtIt) {
  for (const double height : {0.0, 1e-15, -1e-15, 2e-7, -2e-7}) {
    Scene scene;
    const int lamp = test::add_material(scene, test::diffuse(scene.bands, 0.0f, 100.0f));
    const int grey = test::add_material(scene, test::diffuse(scene.bands, 0.5f));
    test::add_polygon(scene, "ceiling", grey, {{0, 0, 3}, {0, 4, 3}, {5, 4, 3}, {5, 0, 3}});
    const double z = 3.0 + height;
    test::add_polygon(scene, "lamp", lamp, {{2, 1, z}, {2, 2, z}, {3, 2, z}, {3, 1, z}});
    const PatchMesh mesh = build_patches(scene, {.max_patch_size = 1.0});
    const ElementCaster caster(mesh);
    const DirectLight light(scene, mesh);
    const Spectrum E =
        light.irradiance(caster, {.at = {{2.3, 1.7, 3.0}, -Eigen::Vector3d::UnitZ(), 0}, .key = 7});
    EXPECT_EQ(E[0], 0.0f) << height;
  }
}

// A point that drawn lights are compared with all lights at: a large emitter through whose plane
// the point's horizon runs, with its middle below the horizon; small emitters of other brightness,
// one behind the point; a sphere; a lamp. Nothing stands between.
TEST(DirectLight, OneLightStandsForAllInTheMean) {
  Scene scene;
  const auto shines = [&](float M) {
    return test::add_material(scene, test::diffuse(scene.bands, 0.0f, M));
  };
  test::add_polygon(scene, "wall", shines(1.0f), {{3, 2, -4}, {3, -2, -4}, {3, -2, 1}, {3, 2, 1}});
  test::add_polygon(scene, "panel", shines(40.0f), {{0, 0, 3}, {0, 1, 3}, {1, 1, 3}, {1, 0, 3}});
  test::add_polygon(scene, "dim", shines(2.0f), {{-2, 0, 2}, {-2, 1, 2}, {-1, 1, 2}, {-1, 0, 2}});
  test::add_polygon(scene, "behind", shines(90.0f),
                    {{0, 0, -1}, {1, 0, -1}, {1, 1, -1}, {0, 1, -1}});
  scene.surfaces.push_back({.name = "ball",
                            .material = shines(5.0f),
                            .shape = Sphere{.center = {-2, -2, 1.5}, .radius = 0.5}});
  Lamp lamp{.name = "lamp", .position = {0.5, -2.0, 2.0}};
  lamp.intensity = constant_spectrum(scene.bands, 3.0f);
  scene.lamps.push_back(lamp);
  const int black = test::add_material(scene, test::diffuse(scene.bands, 0.0f));
  test::add_polygon(scene, "far", black, {{-9, -9, -9}, {9, -9, -9}, {9, 9, -9}, {-9, 9, -9}});
  const PatchMesh mesh = build_patches(scene, {.max_patch_size = 2.0});
  const ElementCaster caster(mesh);
  const DirectLight light(scene, mesh);
  ASSERT_EQ(light.light_count(), 6);
  const SurfacePoint at{
      .position = Eigen::Vector3d::Zero(), .normal = Eigen::Vector3d::UnitZ(), .facet = -1};
  const double all = light.irradiance(caster, {.at = at})[0];

  constexpr int count = 20000;
  double sum = 0.0, squares = 0.0;
  for (int key = 0; key < count; ++key) {
    const double E = light.irradiance(caster, {.at = at,
                                               .key = static_cast<std::uint64_t>(key),
                                               .shadows = {.min_rays = 1, .max_rays = 1},
                                               .one_stands_for_all = true})[0];
    sum += E;
    squares += E * E;
  }
  const double mean = sum / count, variance = squares / count - mean * mean;
  // Four standard errors, which independent numbers exceed once in 16 000 times.
  EXPECT_NEAR(mean, all, 4.0 * std::sqrt(variance / count));
  // Draws in proportion to the light would have no variance at all; even ones over six lights, of
  // which one gives most, would have five times the square of the mean. Below one, a draw errs by
  // less than the light.
  EXPECT_LT(variance, all * all);
}

struct MeanLight {
  double mean = 0.0, error = 0.0;  // standard error of the mean
};

MeanLight mean_light(const DirectLight& light, const ElementCaster& caster, const SurfacePoint& at,
                     const ShadowOptions& shadows) {
  constexpr int count = 4096;
  double sum = 0.0, squares = 0.0;
  for (int key = 0; key < count; ++key) {
    const double E = light.irradiance(
        caster,
        {.at = at, .key = random_key(static_cast<std::uint64_t>(key)), .shadows = shadows})[0];
    sum += E;
    squares += E * E;
  }
  const double mean = sum / count;
  return {.mean = mean, .error = std::sqrt(std::max(0.0, squares / count - mean * mean) / count)};
}

// Ball lamps have no exact shares. The edge of a lid moves across the lamp, and leaves from 2 to
// 98 % of its disc of radius 0.2 visible; the first few rays often agree at either end.
TEST(DirectLight, LightIsRightInTheMeanWhereFewFirstRaysDisagree) {
  for (const double edge : {-0.0905, -0.085, -0.07, 0.0, 0.07, 0.085, 0.0905}) {
    Scene scene;
    const int shines = test::add_material(scene, test::diffuse(scene.bands, 0.0f, 100.0f));
    const int black = test::add_material(scene, test::diffuse(scene.bands, 0.0f));
    scene.surfaces.push_back(
        {.name = "ball", .material = shines, .shape = Sphere{.center = {0, 0, 2}, .radius = 0.2}});
    test::add_polygon(scene, "lid", black, {{edge, -3, 1}, {3, -3, 1}, {3, 3, 1}, {edge, 3, 1}});
    test::add_polygon(scene, "far", black, {{-9, -9, -9}, {9, -9, -9}, {9, 9, -9}, {-9, 9, -9}});
    const PatchMesh mesh = build_patches(scene, {.max_patch_size = 5.0});
    const ElementCaster caster(mesh);
    const DirectLight light(scene, mesh);
    const SurfacePoint at{
        .position = Eigen::Vector3d::Zero(), .normal = Eigen::Vector3d::UnitZ(), .facet = -1};
    // Rays whose number is fixed have no stage to decide on.
    const MeanLight fixed = mean_light(light, caster, at, {.min_rays = 64, .max_rays = 64});
    for (const auto& [least, most] : {std::pair(16, 64), {8, 13}, {9, 32}, {3, 64}}) {
      const MeanLight staged = mean_light(light, caster, at, {.min_rays = least, .max_rays = most});
      // Four standard errors, which independent numbers exceed once in 16 000 times.
      EXPECT_NEAR(staged.mean, fixed.mean, 4.0 * std::hypot(staged.error, fixed.error))
          << edge << ' ' << least << ' ' << most;
      EXPECT_GT(staged.error, 0.0);
    }
  }
}

// A lamp as long as 2 m, 2 m above an upright receiver at the origin, that begins at x = 0 above
// it.
struct UprightReceiver {
  UprightReceiver(double lamp_width, bool is_covered) {
    const int shines = test::add_material(scene, test::diffuse(scene.bands, 0.0f, 100.0f));
    const int black = test::add_material(scene, test::diffuse(scene.bands, 0.0f));
    const double w = lamp_width;
    test::add_polygon(scene, "lamp", shines, {{0, -1, 2}, {0, 1, 2}, {w, 1, 2}, {w, -1, 2}});
    if (is_covered) {
      test::add_polygon(scene, "lid", black, {{0.02, -3, 1}, {3, -3, 1}, {3, 3, 1}, {0.02, 3, 1}});
    }
    test::add_polygon(scene, "far", black, {{-9, -9, -9}, {9, -9, -9}, {9, 9, -9}, {-9, 9, -9}});
  }

  Scene scene;
  SurfacePoint at{
      .position = Eigen::Vector3d::Zero(), .normal = Eigen::Vector3d::UnitX(), .facet = -1};
};

// Beneath the lid only the first 4 cm of the lamp are visible, which weigh little by their cosine.
TEST(DirectLight, OneRayOfALampIsRightInTheMeanBehindASlit) {
  const UprightReceiver narrow(0.04, false), wide(2.0, true);
  const PatchMesh narrow_mesh = build_patches(narrow.scene, {.max_patch_size = 5.0}),
                  wide_mesh = build_patches(wide.scene, {.max_patch_size = 5.0});
  const ElementCaster narrow_caster(narrow_mesh), wide_caster(wide_mesh);
  const double expected =
      DirectLight(narrow.scene, narrow_mesh).irradiance(narrow_caster, {.at = narrow.at})[0];
  ASSERT_GT(expected, 0.0);
  const DirectLight light(wide.scene, wide_mesh);
  ASSERT_EQ(light.light_count(), 1);

  constexpr int count = 200000;
  double sum = 0.0, squares = 0.0;
  for (int key = 0; key < count; ++key) {
    const double E = light.irradiance(wide_caster, {.at = wide.at,
                                                    .key = static_cast<std::uint64_t>(key),
                                                    .shadows = {.min_rays = 1, .max_rays = 1},
                                                    .one_stands_for_all = true})[0];
    sum += E;
    squares += E * E;
  }
  const double mean = sum / count, error = std::sqrt((squares / count - mean * mean) / count);
  // Four standard errors. Were the whole of the light given to each ray that gets through, the mean
  // would be several times as great, since the visible part has small cosines.
  EXPECT_NEAR(mean, expected, 4.0 * error);
  // Four errors of a twentieth are a fifth of the light: far less than that fault.
  EXPECT_LT(error, 0.05 * expected);
}

}  // namespace
}  // namespace lightwell::direct_light_test
