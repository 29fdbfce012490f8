#include "raytrace/shading/shade.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <numbers>
#include <utility>

#include "scene/optics.h"
#include "scene/sampling.h"
#include "tests/raytrace/lit_scene.h"

namespace lightwell::shade_test {
namespace {

constexpr double pi = std::numbers::pi;
constexpr auto pi_f = static_cast<float>(pi);
const Eigen::Vector3d up = Eigen::Vector3d::UnitZ();

// Closed forms by name. The object is static, since loops run over its members.
const nlohmann::json& closed_forms(const std::string& name) {
  static const nlohmann::json all = [] {
    std::ifstream file(LIGHTWELL_TEST_DATA "/raytrace/optics.json");
    return nlohmann::json::parse(file);
  }();
  return all.at(name);
}

Eigen::Vector3d vector(const nlohmann::json& xyz) {
  return {xyz[0].get<double>(), xyz[1].get<double>(), xyz[2].get<double>()};
}

/// Unit vector in the x-z plane, `degrees` from straight down.
Eigen::Vector3d downwards(double degrees) {
  return {std::sin(degrees * pi / 180.0), 0.0, -std::cos(degrees * pi / 180.0)};
}

// Radiance of the first band; all bands are equal in these grey scenes.
float radiance(const TracedScene& lit, const Ray& ray, const RenderOptions& options = {}) {
  return RayTree(lit.scene, lit.caster, lit.direct_light, lit.solution, options)
      .trace(ray, 1)
      .radiance[0];
}

/// A glass surface z = 0 between a lamp of radiance 1 far above and one of radiance 100 far below:
/// radiance separates reflected from refracted light.
TracedScene& glass_between_lamps() {
  static TracedScene lit(SceneBuilder()
                             .square({.index_of_refraction = 1.5f}, {0, 0, 0}, up, 1000)
                             .square({.exitance = pi_f}, {0, 0, 10}, -up, 1000)
                             .square({.exitance = 100 * pi_f}, {0, 0, -10}, up, 1000)
                             .build());
  return lit;
}

TEST(RayTree, FresnelSharesOfAirToGlass) {
  for (const auto& [degrees, R] : closed_forms("fresnel_air_to_glass")["R"].items()) {
    const double r = R.get<double>();
    const Ray ray{.origin = {0, 0, 1}, .direction = downwards(std::stod(degrees))};
    // Radiance in glass is n^2 times that before its surface. Eye rays start at z = 1 in double
    // precision; the float sum has 7 digits.
    const double seen = 100 / (1.5 * 1.5);
    EXPECT_NEAR(radiance(glass_between_lamps(), ray), r + seen * (1 - r), 1e-5 * 100) << degrees;
  }
}

TEST(RayTree, TotalInternalReflectionInGlass) {
  for (const auto& [degrees, R] : closed_forms("fresnel_glass_to_air")["R"].items()) {
    const double r = R.get<double>();
    const Ray ray{.origin = {0, 0, -1}, .direction = -downwards(std::stod(degrees))};
    // Radiance that comes in from the air is n^2 times that outside.
    const double seen = 1.5 * 1.5;
    EXPECT_NEAR(radiance(glass_between_lamps(), ray), 100 * r + seen * (1 - r), 1e-5 * 100)
        << degrees;
  }
}

TEST(RayTree, SlabPassesWhatItsManyReflectionsLeave) {
  // Two surfaces of reflectance R = 0.04 and tint t: T = t^2 (1-R)^2 / (1-R^2); t = 1 gives
  // (1-R)/(1+R).
  for (const float tint : {1.0f, 0.5f}) {
    const Paint glass{.index_of_refraction = 1.5f, .tint = tint};
    const TracedScene lit(SceneBuilder()
                              .box(glass, {-5, -5, 0}, {5, 5, 1}, false)
                              .square({.exitance = pi_f}, {0, 0, -4}, up, 20)
                              .build());
    const Ray ray{.origin = {0.1, 0.2, 3}, .direction = -up};
    const double T = closed_forms("slab_transmittance")["T"].get<double>() * tint * tint;
    EXPECT_NEAR(radiance(lit, ray, {.max_depth = 20, .min_contribution = 1e-9f}), T, 1e-6);
  }
}

// N slabs without absorption, each of reflectance R1 = 2 r / (1 + r) for one polarisation, pass
// (1 - R1) / (1 + (N - 1) R1) of it, by all reflections within and between them (Stokes 1862).
double stack_transmittance(double degrees, int count) {
  const PolarisedReflectance face = polarised_reflectance(std::cos(degrees * pi / 180.0), 1.5);
  double T = 0.0;
  for (const double r : {face.s, face.p}) {
    const double R1 = 2.0 * r / (1.0 + r);
    T += 0.5 * (1.0 - R1) / (1.0 + (count - 1) * R1);
  }
  return T;
}

TEST(RayTree, StackOfSlabsPassesTheSumOfAllItsReflections) {
  // The values of two slabs by the transfer matrices of each polarisation.
  EXPECT_NEAR(stack_transmittance(0.0, 2), 0.8571428571428573, 1e-12);
  EXPECT_NEAR(stack_transmittance(60.0, 2), 0.7655600160281887, 1e-12);
  for (const bool thin : {false, true}) {
    for (int count = 1; count <= 4; ++count) {
      SceneBuilder builder;
      for (int i = 0; i < count; ++i) {
        const double z = 0.2 * i;
        if (thin) {
          builder.square({.index_of_refraction = 1.5f, .thin = true}, {0, 0, z}, up, 60);
        } else {
          builder.box({.index_of_refraction = 1.5f}, {-60, -60, z}, {60, 60, z + 0.1}, false);
        }
      }
      const TracedScene lit(builder.square({.exitance = pi_f}, {0, 0, -0.5}, up, 80).build());
      const RenderOptions options;
      const RayTree tree(lit.scene, lit.caster, lit.direct_light, lit.solution, options);
      for (const double degrees : {0.0, 30.0, 60.0, 75.0}) {
        constexpr int keys = 100;
        double sum = 0.0, squares = 0.0;
        for (int key = 0; key < keys; ++key) {
          const Ray ray{.origin = {0.1, 0.2, 3}, .direction = downwards(degrees)};
          const auto L =
              static_cast<double>(tree.trace(ray, static_cast<std::uint64_t>(key)).radiance[0]);
          sum += L;
          squares += L * L;
        }
        const double T = stack_transmittance(degrees, count), mean = sum / keys;
        const double variance = std::max(0.0, squares / keys - mean * mean);
        const double standard_error = std::sqrt(variance / (keys - 1));
        // Branches below a thousandth are reflected or cross by chance. Besides four standard
        // errors of that, the depth of 128 surfaces and single precision are left.
        EXPECT_NEAR(mean, T, 2e-4 * T + 4.0 * standard_error)
            << thin << ' ' << count << ' ' << degrees;
        EXPECT_LT(standard_error, 1.5e-3 * T) << thin << ' ' << count << ' ' << degrees;
      }
    }
  }
}

// An eye within solid glass sees what lies in the glass dimmed by the length of the way, straight
// and by way of a mirror in the glass.
TEST(RayTree, EyeWithinABodySeesItDimmedByTheWay) {
  constexpr double absorption = 0.5;
  const TracedScene lit(
      SceneBuilder()
          .box({.index_of_refraction = 1.5f, .absorption = 0.5f}, {-5, -5, -5}, {5, 5, 5}, false)
          .square({.exitance = pi_f}, {0, 0, -2}, up, 0.5)
          .square({.specular = 0.9f}, {0, 0, 1}, -up, 0.5)
          .build());
  // The mirror is met at the distance 1, and the lamp another 3 from there.
  const std::array<std::pair<Eigen::Vector3d, double>, 2> views = {
      {{-up, std::exp(-2.0 * absorption)}, {up, 0.9 * std::exp(-4.0 * absorption)}}};
  for (const auto& [direction, expected] : views) {
    const Ray ray{.origin = {0.1, 0.2, 0}, .direction = direction};
    // Products of a few floats.
    EXPECT_NEAR(radiance(lit, ray), expected, std::ldexp(8.0, -24));
  }
}

TEST(RayTree, SlabShiftsARaySideways) {
  for (const auto& [degrees, value] : closed_forms("slab_displacement")["shift"].items()) {
    const double angle = std::stod(degrees);
    const double shift = value.get<double>();
    const Eigen::Vector3d d = downwards(angle);
    const Eigen::Vector3d eye = Eigen::Vector3d(0, 0, 1.5) - 0.5 * d;
    // Inside the glass the ray is steeper, so it leaves on the near side of the straight line.
    const Eigen::Vector3d sideways(-std::cos(angle * pi / 180.0), 0, -std::sin(angle * pi / 180.0));
    const Eigen::Vector3d lamp = eye + 9.0 * d + shift * sideways;
    constexpr double radius = 1e-3;
    const TracedScene lit(SceneBuilder()
                              .box({.index_of_refraction = 1.5f}, {-9, -9, 0.5}, {9, 9, 1.5}, false)
                              .sphere({.exitance = pi_f}, lamp, radius)
                              .build());
    // A ray aimed at the lamp hits; a ray beyond the lamp's edge by a tenth of its radius does not.
    const auto seen_at = [&](double off) {
      return radiance(lit, {.origin = eye + off * radius * sideways, .direction = d});
    };
    EXPECT_GT(seen_at(0.0), 0.0f) << degrees;
    EXPECT_GT(seen_at(0.9), 0.0f) << degrees;
    EXPECT_GT(seen_at(-0.9), 0.0f) << degrees;
    EXPECT_EQ(seen_at(1.1), 0.0f) << degrees;
    EXPECT_EQ(seen_at(-1.1), 0.0f) << degrees;
  }
}

TEST(RayTree, MirrorShowsAPointAtItsImage) {
  for (const auto& test : closed_forms("mirror_images")["cases"]) {
    const Eigen::Vector3d point = vector(test["point"]), image = vector(test["image"]);
    const Eigen::Vector3d q = vector(test["plane_point"]);
    Eigen::Vector3d n = vector(test["plane_normal"]).normalized();
    if ((point - q).dot(n) < 0) n = -n;
    constexpr double radius = 1e-3;
    const TracedScene lit(SceneBuilder()
                              .square({.specular = 0.9f}, q, n, 60)
                              .sphere({.exitance = pi_f}, point, radius)
                              .build());
    const Eigen::Vector3d eye = q + 2.5 * n + 1.7 * n.unitOrthogonal();
    const Eigen::Vector3d d = (image - eye).normalized();
    const Eigen::Vector3d across = d.unitOrthogonal();
    const auto seen_at = [&](double off) {
      return radiance(lit, {.origin = eye + off * radius * across, .direction = d});
    };
    EXPECT_FLOAT_EQ(seen_at(0.0), 0.9f);
    EXPECT_FLOAT_EQ(seen_at(0.9), 0.9f);
    EXPECT_FLOAT_EQ(seen_at(-0.9), 0.9f);
    EXPECT_EQ(seen_at(1.1), 0.0f);
    EXPECT_EQ(seen_at(-1.1), 0.0f);
  }
}

TEST(RayTree, MirrorPathMeetsTheLampWhereTheImageMethodSays) {
  const auto path = closed_forms("mirror_path");
  const TracedScene lit(SceneBuilder()
                            .square({.specular = 1.0f}, {0, 0, 0}, up, 10)
                            .sphere({.exitance = pi_f}, vector(path["light"]), 1e-3)
                            .build(),
                        5.0);
  const Eigen::Vector3d eye = vector(path["eye"]);
  EXPECT_FLOAT_EQ(radiance(lit, {.origin = eye, .direction = vector(path["hit"]) - eye}), 1.0f);
}

TEST(RayTree, MirrorAndDiffuseSharesOfOneSurfaceAdd) {
  TracedScene lit(SceneBuilder()
                      .square({.reflectance = 0.5f, .specular = 0.25f}, {0, 0, 0}, up, 1)
                      .square({.exitance = 8 * pi_f}, {0, 0, 5}, -up, 50)
                      .build());
  lit.set_indirect([](const auto&) { return 2 * pi_f; });
  // The lamp is the larger part of the scene, so its light is part of indirect irradiance:
  // 0.5 * 2 pi / pi + 0.25 * 8.
  const Ray ray{.origin = {0.2, 0.1, 1}, .direction = downwards(20)};
  EXPECT_NEAR(radiance(lit, ray), 3.0f, 1e-5f);
}

TEST(RayTree, LightIsSeenFromTheSideThatEmits) {
  const Ray above{.origin = {0.1, 0.1, 1}, .direction = -up};
  const Ray below{.origin = {0.1, 0.1, -1}, .direction = up};
  const auto lamp = [](const Paint& paint) {
    return TracedScene(SceneBuilder().square(paint, {0, 0, 0}, up, 1).build());
  };
  EXPECT_FLOAT_EQ(radiance(lamp({.exitance = 2 * pi_f}), above), 2.0f);
  EXPECT_FLOAT_EQ(radiance(lamp({.exitance = 2 * pi_f}), below), 0.0f);
  EXPECT_FLOAT_EQ(radiance(lamp({.exitance = 2 * pi_f, .emits_both_sides = true}), below), 2.0f);
}

TEST(RayTree, BackOfAOneSidedSurfaceIsBlack) {
  TracedScene lit(SceneBuilder()
                      .square({.reflectance = 0.5f, .one_sided = true}, {0, 0, 0}, up, 1)
                      .square({.specular = 1.0f, .one_sided = true}, {0, 0, 3}, up, 1)
                      .build());
  lit.set_indirect([](const auto&) { return 2 * pi_f; });
  EXPECT_FLOAT_EQ(radiance(lit, {.origin = {0.1, 0.1, 1}, .direction = -up}), 1.0f);
  EXPECT_EQ(radiance(lit, {.origin = {0.1, 0.1, -1}, .direction = up}), 0.0f);
  EXPECT_EQ(radiance(lit, {.origin = {0.1, 0.1, 2}, .direction = up}), 0.0f);  // mirror from behind
}

TEST(RayTree, GlassStandingOnAFloorShowsTheFloor) {
  TracedScene lit(SceneBuilder()
                      .square({.reflectance = 1.0f, .one_sided = true}, {0, 0, 0}, up, 10)
                      .box({.index_of_refraction = 1.5f}, {-1, -1, 0}, {1, 1, 1}, false)
                      .build());
  lit.set_indirect([](const auto&) { return pi_f; });
  // Straight down, the floor of radiance 1 lies behind one surface if floor and base coincide, and
  // behind two surfaces with their reflections if air is between them.
  const double R = 0.04;
  for (int i = 0; i < 200; ++i) {
    const double x = 1.8 * random_uniform(static_cast<std::uint64_t>(i)) - 0.9;
    const double y = 1.8 * random_uniform(static_cast<std::uint64_t>(i + 1000)) - 0.9;
    const float L = radiance(lit, {.origin = {x, y, 3}, .direction = -up});
    EXPECT_GT(L, (1 - R) / (1 + R) - 1e-3);
    EXPECT_LT(L, 1.0);
  }
}

TEST(RayTree, GlassSphereInAUniformWorldIsInvisible) {
  // Reflected and refracted shares add up to 1 at every surface, so glass in a world of radiance 1
  // has radiance 1, except for the share of the deepest branch: after k internal reflections
  // (1-R) R^k < 1 / (e k) for any R.
  constexpr int depth = 500;
  const TracedScene lit(SceneBuilder()
                            .box({.exitance = pi_f}, {-3, -3, -3}, {3, 3, 3}, true)
                            .sphere({.index_of_refraction = 1.5f}, {0.1, 0, 0}, 1.0)
                            .build());
  for (int i = 0; i <= 400; ++i) {
    const double off = 1.05 * i / 400.0;
    const Ray ray{.origin = {0.1 + off, 0, 2.5}, .direction = -up};
    EXPECT_NEAR(radiance(lit, ray, {.max_depth = depth, .min_contribution = 1e-6f}), 1.0,
                1.0 / (std::numbers::e * depth) + 1e-4)
        << off;
  }
}

// A bulb in the middle of a ball of glass: what is reflected at the ball ends at the black bulb, so
// L = (1 - R) M / (pi n^2) along the radius. The bulb looks n times larger, and its flux stays.
// Bodies within bodies multiply their relative indices.
TEST(RayTree, GlassAroundALampSpreadsItsLight) {
  constexpr double n = 1.5, water = 1.33;
  const auto share = [](double relative) {
    return 1.0 - std::pow((relative - 1.0) / (relative + 1.0), 2);
  };
  const Ray ray{.origin = {0, 0, 3}, .direction = -up};
  const TracedScene ball(SceneBuilder()
                             .sphere({.index_of_refraction = 1.5f}, {0, 0, 0}, 1.0)
                             .square({.exitance = pi_f}, {0, 0, 0}, up, 0.1)
                             .build());
  EXPECT_NEAR(radiance(ball, ray), share(n) / (n * n), 1e-6);  // floats have 7 digits
  const TracedScene filled(SceneBuilder()
                               .sphere({.index_of_refraction = 1.5f}, {0, 0, 0}, 1.0)
                               .sphere({.index_of_refraction = 1.33f / 1.5f}, {0, 0, 0}, 0.5)
                               .square({.exitance = pi_f}, {0, 0, 0}, up, 0.1)
                               .build());
  // Between glass and water R1 R2 = 0.04 * 0.0036 of the light is reflected to the bulb once more.
  EXPECT_NEAR(radiance(filled, ray), share(n) * share(water / n) / (water * water), 1.5e-4);
}

// Under water the sky is n^2 times as bright as above, and narrower.
TEST(RayTree, AnEyeUnderWaterSeesTheWorldSquaredIndexTimesAsBright) {
  constexpr double n = 1.33;
  const TracedScene lit(SceneBuilder()
                            .square({.index_of_refraction = 1.33f}, {0, 0, 0}, up, 5.0)
                            .square({.exitance = pi_f}, {0, 0, 2}, -up, 5.0)
                            .build());
  const double R = std::pow((n - 1.0) / (n + 1.0), 2);
  const Ray ray{.origin = {0, 0, -1}, .direction = up};
  EXPECT_NEAR(radiance(lit, ray), n * n * (1.0 - R), 1e-6);  // floats have 7 digits
}

TEST(RayTree, DirectLightHasTheExactPenumbra) {
  const TracedScene lit(SceneBuilder()
                            .square({.reflectance = 1.0f}, {0, 0, 0}, up, 5)
                            .square({.exitance = pi_f, .one_sided = true}, {0, 0, 2}, -up, 0.5)
                            .polygon({}, {{0, -50, 1}, {0, 50, 1}, {-50, 50, 1}, {-50, -50, 1}})
                            .build());
  const RenderOptions options{.shadows = {.min_rays = 64, .max_rays = 64}};
  const RayTree tree(lit.scene, lit.caster, lit.direct_light, lit.solution, options);
  constexpr int keys = 64;
  for (const auto& row : closed_forms("penumbra")["rows"]) {
    const double x = row[0].get<double>(), E = row[1].get<double>(), open = row[2].get<double>();
    double sum = 0.0;
    for (int key = 0; key < keys; ++key) {
      const Ray ray{.origin = {x, 0, 0.5}, .direction = -up};
      sum += pi * tree.trace(ray, static_cast<std::uint64_t>(key)).radiance[0];
    }
    // The shadow's edge crosses about 2 sqrt(64) of the 64 strata of a lamp in two triangles, each
    // with variance of at most 1/4: sigma = sqrt(16/4)/64 = 1/32 of the unoccluded irradiance per
    // key.
    EXPECT_NEAR(sum / keys, E, 4.0 / 32.0 / std::sqrt(keys) * open) << "at x = " << x;
  }
}

TEST(RayTree, FingerprintTellsFacesNotFacetsOfASmoothSurface) {
  // A column of 120 facets, 3 degrees apart, in front of a wall.
  PolygonMesh column;
  constexpr int sides = 120;
  for (int i = 0; i < sides; ++i) {
    const double phi = 2 * pi * i / sides;
    column.vertices.emplace_back(std::cos(phi), std::sin(phi), -2);
    column.vertices.emplace_back(std::cos(phi), std::sin(phi), 2);
    const int next = (i + 1) % sides;
    column.facets.push_back({.boundary = {2 * i, 2 * next, 2 * next + 1, 2 * i + 1}});
  }
  Scene scene =
      SceneBuilder().square({.reflectance = 0.5f}, {0, 5, 0}, -up.unitOrthogonal(), 1).build();
  scene.surfaces[0] = {
      .name = "wall",
      .shape = PolygonMesh{.vertices = {{-9, 5, -9}, {9, 5, -9}, {9, 5, 9}, {-9, 5, 9}},
                           .facets = {{.boundary = {0, 1, 2, 3}}}}};
  scene.surfaces.push_back({.name = "column", .shape = column});
  const TracedScene lit(scene);
  const RenderOptions options;
  const RayTree tree(lit.scene, lit.caster, lit.direct_light, lit.solution, options);
  const auto print = [&](double x) {
    return tree.fingerprint({.origin = {x, -4, 0.1}, .direction = {0, 1, 0}});
  };
  EXPECT_EQ(print(0.013), print(0.41));
  EXPECT_EQ(print(0.013), print(-0.83));
  EXPECT_EQ(print(1.2), print(1.5));
  EXPECT_NE(print(0.013), print(1.2));
}

}  // namespace
}  // namespace lightwell::shade_test
