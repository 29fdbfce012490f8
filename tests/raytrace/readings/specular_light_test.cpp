#include "raytrace/readings/specular_light.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

#include "radiosity/closed_forms/polygon_form_factor.h"
#include "raytrace/shading/shade.h"
#include "scene/optics.h"
#include "scene/parallel.h"
#include "scene/sampling.h"
#include "tests/raytrace/lit_scene.h"
#include "tests/sample_mean.h"

namespace lightwell::specular_light_test {
namespace {

using Eigen::Vector3d;

const Vector3d up = Vector3d::UnitZ();
// Newton's method ends within 1e-6 of the goal; its derivatives are central differences over 1e-3
// rad.
constexpr double of_newton = 1e-4;
// Four standard errors of the accuracy asked for.
const double of_rays = 4.0 * SpecularLightOptions{}.accuracy;

double irradiance(const TracedScene& lit, const Vector3d& position, const Vector3d& normal,
                  const SpecularLightOptions& options = {}) {
  const std::vector<GatherPoint> points = {{.position = position, .normal = normal}};
  return specular_irradiance({lit.scene, lit.caster, lit.direct_light}, lit.solution, points,
                             options)
      .irradiance(0, 0);
}

// A wide mirror in z = 0 and, far off, a black wall that makes small emitters a small share of the
// scene's area.
SceneBuilder over_a_mirror(float specular, float roughness = 0.0f) {
  return SceneBuilder().square({.specular = specular, .one_sided = true, .roughness = roughness},
                               Vector3d::Zero(), up, 20.0);
}

Lamp point_lamp(const Scene& scene, const Vector3d& position, float intensity) {
  return {.name = "point",
          .position = position,
          .intensity = constant_spectrum(scene.bands, intensity)};
}

TEST(SpecularLight, OfASquareLampIsThatOfItsImage) {
  constexpr float M = 10.0f, rho = 0.8f;
  const Vector3d at(0.3, 0.2, 1.0), towards_floor(0.0, 0.0, -1.0);
  for (const double side : {1.0, 0.1, 0.01}) {
    const TracedScene lit(
        over_a_mirror(rho)
            .square({.exitance = M, .one_sided = true}, {0.0, 0.5, 2.0}, -up, 0.5 * side)
            .build());
    const double h = 0.5 * side;
    const Loop image = {
        {-h, 0.5 - h, -2.0}, {h, 0.5 - h, -2.0}, {h, 0.5 + h, -2.0}, {-h, 0.5 + h, -2.0}};
    const double expected = rho * M * std::abs(point_to_polygon(at, towards_floor, image));
    EXPECT_NEAR(irradiance(lit, at, towards_floor), expected, of_rays * expected) << side;
  }
}

TEST(SpecularLight, OfAPointLampIsThatOfItsImage) {
  Scene scene = over_a_mirror(0.5f).build();
  scene.lamps.push_back(point_lamp(scene, {1.0, -2.0, 3.0}, 7.0f));
  const TracedScene lit(scene);
  const Vector3d at(0.4, 0.3, 0.8), normal = Vector3d(0.3, 0.1, -1.0).normalized();
  const Vector3d to = Vector3d(1.0, -2.0, -3.0) - at;
  const double expected = 0.5 * 7.0 * to.normalized().dot(normal) / to.squaredNorm();
  EXPECT_NEAR(irradiance(lit, at, normal), expected, of_newton * expected);
  // Looking up, the point sees no mirror.
  EXPECT_EQ(irradiance(lit, at, up), 0.0);
}

TEST(SpecularLight, IsGoneWhereSomethingStandsBeforeTheImage) {
  Scene scene = over_a_mirror(0.5f).square({}, {0.0, 0.0, 0.5}, up, 0.1).build();
  scene.lamps.push_back(point_lamp(scene, {0.0, 0.0, 3.0}, 7.0f));
  const TracedScene lit(scene);
  EXPECT_EQ(irradiance(lit, {0.0, 0.0, 1.0}, -up), 0.0);
  EXPECT_GT(irradiance(lit, {0.5, 0.0, 1.0}, -up), 0.0);
}

// The narrow faces of the plate reflect light too, and lie too far off to matter.
// On the axis of a plate of thickness d and index n, light that goes to and fro k times within the
// plate comes from h - d + (1 + 2 k) d / n away and has passed two faces: T = (1 - R)^2 R^(2 k).
TEST(SpecularLight, ThroughAPlateAddsUpItsInnerReflections) {
  constexpr double n = 1.5, d = 0.1, h = 2.0;
  Scene scene = SceneBuilder()
                    .box({.index_of_refraction = 1.5f}, {-40, -40, 1.0}, {40, 40, 1.0 + d}, false)
                    .build();
  scene.lamps.push_back(point_lamp(scene, {0.0, 0.0, h}, 5.0f));
  const TracedScene lit(scene);
  const double R = fresnel_reflectance(1.0, n);
  double expected = 0.0;
  for (int k = 0; k < 4; ++k) {
    const double r = h - d + (1 + 2 * k) * d / n;
    expected += 5.0 * std::pow(1.0 - R, 2) * std::pow(R, 2 * k) / (r * r);
  }
  // R^4 = 2.6e-6 is below the weight that branches are followed at, 1e-4, times (1 - R)^2.
  EXPECT_NEAR(irradiance(lit, Vector3d::Zero(), up), expected, (of_newton + 1e-5) * expected);
}

// Slabs of a millimetre, a millimetre apart. Of each polarisation they pass
// (1 - R1) / (1 + (N - 1) R1), R1 = 2 r / (1 + r), by all reflections within and between them
// (Stokes 1862). A lamp of intensity I in height h gives E = I T sin a / (x dx/da) at the distance
// x that light of the angle a goes sideways.
TEST(SpecularLight, ThroughAStackOfSlabsIsAllItsReflections) {
  constexpr double n = 1.5, d = 1e-3, h = 2.0;
  for (const int count : {1, 2, 3}) {
    SceneBuilder builder;
    for (int i = 0; i < count; ++i) {
      const double z = 1.0 + 2.0 * d * i;
      builder.box({.index_of_refraction = 1.5f}, {-8, -8, z}, {8, 8, z + d}, false);
    }
    Scene scene = builder.build();
    scene.lamps.push_back(point_lamp(scene, {0.0, 0.0, h}, 5.0f));
    const TracedScene lit(scene);
    for (const double degrees : {30.0, 60.0}) {
      const double a = degrees * std::numbers::pi / 180.0, inside = std::asin(std::sin(a) / n);
      const double air = h - count * d, glass = count * d;
      const double x = air * std::tan(a) + glass * std::tan(inside);
      const double slope = air / std::pow(std::cos(a), 2) +
                           glass * std::cos(a) / (n * std::pow(std::cos(inside), 3));
      const PolarisedReflectance face = polarised_reflectance(std::cos(a), n);
      double T = 0.0;
      for (const double r : {face.s, face.p}) {
        const double R1 = 2.0 * r / (1.0 + r);
        T += 0.5 * (1.0 - R1) / (1.0 + (count - 1) * R1);
      }
      const double expected = 5.0 * T * std::sin(a) / (x * slope);
      // Light that goes to and fro comes from a few millimetres farther away, 2e-3 of the distance
      // at most, and is less than a fifth of all.
      EXPECT_NEAR(irradiance(lit, {x, 0.0, 0.0}, up), expected, 1e-3 * expected)
          << count << ' ' << degrees;
    }
  }
}

// The plane of symmetry of a small lamp is a border of strata. Newton's method finds the lamp in
// the stratum on one side; the other side must be looked into as well.
TEST(SpecularLight, OfALampThatLiesInTwoStrataIsWhole) {
  constexpr float M = 10.0f, rho = 0.8f;
  const TracedScene lit(over_a_mirror(rho)
                            .square({.exitance = M, .one_sided = true}, {0.0, 0.0, 2.0}, -up, 0.01)
                            .build());
  for (const double x : {0.5, 1.0, 2.0, 3.0, 4.0}) {
    const Vector3d at(x, 0.0, 1.0);
    const Loop image = {
        {-0.01, -0.01, -2.0}, {0.01, -0.01, -2.0}, {0.01, 0.01, -2.0}, {-0.01, 0.01, -2.0}};
    const double expected = rho * M * std::abs(point_to_polygon(at, -up, image));
    EXPECT_NEAR(irradiance(lit, at, -up), expected, of_rays * expected) << x;
  }
}

void shine(Scene& scene, const Vector3d& sun) {
  scene.sky =
      Sky{.up = up,
          .north = Vector3d::UnitY(),
          .scale = constant_spectrum(scene.bands, 0.0f),
          .ground = constant_spectrum(scene.bands, 0.0f),
          .sun = Sun{.direction = sun, .irradiance = constant_spectrum(scene.bands, 800.0f)}};
  validate(scene);
}

TEST(SpecularLight, OfTheSunOffAMirrorIsItsIrradiance) {
  Scene scene = over_a_mirror(0.9f).build();
  const Vector3d sun = Vector3d(1.0, 2.0, 3.0).normalized();
  shine(scene, sun);
  const TracedScene lit(scene);
  const double expected = 0.9 * 800.0 * sun.z();
  EXPECT_NEAR(irradiance(lit, {0.1, 0.2, 0.7}, -up), expected, of_newton * expected);
}

// The sun at 45 degrees goes down 20 m between two mirrors 1 m apart in 20 reflections, after which
// it goes on as it came. Rays nearby meet 18 or 22 mirrors and leave in their own direction, too,
// but not towards the sun.
TEST(SpecularLight, OfTheSunBetweenTwoMirrorsArrivesOnce) {
  constexpr float rho = 0.95f;
  Scene scene =
      SceneBuilder()
          .polygon({.specular = rho}, {{0, -99, 0}, {0, 99, 0}, {0, 99, 20}, {0, -99, 20}})
          .polygon({.specular = rho}, {{1, -99, 0}, {1, -99, 20}, {1, 99, 20}, {1, 99, 0}})
          .build();
  const Vector3d sun = Vector3d(1.0, 0.0, 1.0).normalized();
  shine(scene, sun);
  const TracedScene lit(scene);
  const double expected = std::pow(double{rho}, 20) * 800.0 * sun.z();
  EXPECT_NEAR(irradiance(lit, {0.3, 0.1, 0.05}, up), expected, of_newton * expected);
}

// The sun lights a horizontal place under water with what passes the surface, however it bends.
TEST(SpecularLight, OfTheSunUnderWaterIsWhatPassesTheSurface) {
  constexpr double n = 1.33;
  Scene scene =
      SceneBuilder().square({.index_of_refraction = 1.33f}, Vector3d::Zero(), up, 20.0).build();
  for (const double degrees : {0.0, 40.0, 70.0}) {
    const double a = degrees * std::numbers::pi / 180.0;
    shine(scene, {std::sin(a), 0.0, std::cos(a)});
    const TracedScene lit(scene);
    const double expected = 800.0 * std::cos(a) * (1.0 - fresnel_reflectance(std::cos(a), n));
    EXPECT_NEAR(irradiance(lit, {0.1, 0.2, -0.7}, up), expected, of_newton * expected) << degrees;
  }
}

// Under water, a lamp straight above is as bright as if the water between were d / n deep.
TEST(SpecularLight, OfALampOverWaterIsThatOfItsApparentDistance) {
  constexpr double n = 1.33, h = 2.0, d = 0.8;
  Scene scene =
      SceneBuilder().square({.index_of_refraction = 1.33f}, Vector3d::Zero(), up, 20.0).build();
  scene.lamps.push_back(point_lamp(scene, {0.0, 0.0, h}, 5.0f));
  const TracedScene lit(scene);
  const double expected = 5.0 * (1.0 - fresnel_reflectance(1.0, n)) / std::pow(h + d / n, 2);
  EXPECT_NEAR(irradiance(lit, {0.0, 0.0, -d}, up), expected, of_newton * expected);
}

// A lobe of roughness 0.02 is a few degrees wide, over which the image of a lamp of 1 m changes by
// less than 2 %.
TEST(SpecularLight, OffASlightlyRoughMirrorIsNearThatOfASmoothOne) {
  const auto light = [](float roughness) {
    const TracedScene lit(over_a_mirror(0.8f, roughness)
                              .square({.exitance = 10.0f, .one_sided = true}, {0, 0, 2}, -up, 0.5)
                              .build());
    return irradiance(lit, {0.3, 0.2, 1.0}, -up);
  };
  const double smooth = light(0.0f);
  EXPECT_NEAR(light(0.02f), smooth, 0.02 * smooth + of_rays * smooth);
}

// Light that a lamp throws off one rough wall after another to a point is found by few rays, which
// bring much of it. Even rays with the same trees have the right mean. Both means have the standard
// errors of their samples, and differ by less than four of these in 15 999 of 16 000 cases.
TEST(SpecularLight, OffOneRoughMirrorByWayOfAnotherIsThatOfEvenRays) {
  Scene scene = SceneBuilder()
                    .box({.specular = 0.7f, .one_sided = true, .roughness = 0.03f}, {0, 0, 0},
                         {4, 3, 2.5}, true)
                    .build();
  scene.lamps.push_back(point_lamp(scene, {3.0, 2.0, 2.0}, 7.0f));
  const TracedScene lit(scene);
  const Vector3d at(1.0, 0.8, 1.0), normal(-1.0, 0.0, 0.0);
  constexpr int repeats = 8;
  SpecularLightOptions options{.most_rays = 1 << 11, .max_depth = 5};
  std::vector<double> found;
  for (int i = 0; i < repeats; ++i) {
    options.replica = static_cast<std::uint64_t>(i);
    found.push_back(irradiance(lit, at, normal, options));
  }
  const RenderOptions tree_options{.max_depth = options.max_depth, .min_contribution = 1e-2f};
  const RayTree tree(lit.scene, lit.caster, lit.direct_light, lit.solution, tree_options);
  Vector3d a, b;
  tangent_frame(normal, a, b);
  std::vector<double> even;
  for (int i = 0; i < 1 << 16; ++i) {
    const std::uint64_t key = random_key(static_cast<std::uint64_t>(i), 1);
    const Vector3d d = cosine_direction(static_cast<float>(random_uniform(key)),
                                        static_cast<float>(random_uniform(random_key(key, 2))));
    const Ray ray{.origin = at, .direction = d.x() * a + d.y() * b + d.z() * normal};
    even.push_back(std::numbers::pi * double{tree.trace_lamps(ray, key)[0]});
  }
  const test::SampleMean a_point = test::mean_of(found), expected = test::mean_of(even);
  const double error = std::hypot(a_point.standard_error, expected.standard_error);
  EXPECT_LT(error, 0.05 * expected.value) << "the test sees losses of 20 %";
  EXPECT_NEAR(a_point.value, expected.value, 4.0 * error);
}

// A lamp shines up, between a floor and a ceiling of lacquer. A point that looks down gets F^2 of
// the light of the lamp's image by both coats, and of the images farther below F^4, a share of F^2
// = 1.6e-3. The image is summed over squares of 1.3 degrees, within which F changes by less than
// 1e-3 of itself. The mean of repeats differs by less than four of its standard errors in 15 999 of
// 16 000 cases.
TEST(SpecularLight, OffOneCoatByWayOfAnotherIsThatOfTheImage) {
  constexpr double height = 2.5, n = 1.5, M = 10.0;
  const Paint lacquer{.one_sided = true, .coat = static_cast<float>(n)};
  const TracedScene lit(
      SceneBuilder()
          .square(lacquer, Vector3d::Zero(), up, 10.0)
          .square(lacquer, {0.0, 0.0, height}, -up, 10.0)
          .square({.exitance = static_cast<float>(M), .one_sided = true}, {1.5, 0.0, 1.2}, up, 0.5)
          .build());
  const Vector3d at(0.0, 0.0, 1.0);
  constexpr double below = 1.2 - 2.0 * height, side = 0.1;
  double expected = 0.0;
  for (double x = 1.0; x < 1.95; x += side) {
    for (double y = -0.5; y < 0.45; y += side) {
      const Loop image = {
          {x, y, below}, {x + side, y, below}, {x + side, y + side, below}, {x, y + side, below}};
      const Vector3d to = Vector3d(x + 0.5 * side, y + 0.5 * side, below) - at;
      const double F = fresnel_reflectance(-to.normalized().z(), n);
      expected += F * F * M * std::abs(point_to_polygon(at, -up, image));
    }
  }
  constexpr int repeats = 32;
  std::vector<double> found;
  for (int i = 0; i < repeats; ++i) {
    found.push_back(irradiance(lit, at, -up, {.replica = static_cast<std::uint64_t>(i)}));
  }
  const test::SampleMean mean = test::mean_of(found);
  EXPECT_LT(mean.standard_error, 0.015 * expected) << "the test sees losses of 6 %";
  EXPECT_NEAR(mean.value, expected, 4.0 * mean.standard_error + (2e-3 + 1.6e-3) * expected);
}

// Other light a hundred times as strong as that of the mirror: a hundredth of the accuracy is
// enough.
TEST(SpecularLight, IsAsExactAsAllLightOfAPointNeeds) {
  const TracedScene lit(
      over_a_mirror(0.8f)
          .square({.exitance = 10.0f, .one_sided = true}, {0.0, 0.5, 2.0}, -up, 0.05)
          .build());
  const std::vector<GatherPoint> points = {{.position = {0.3, 0.2, 1.0}, .normal = -up}};
  const auto light = [&](const std::vector<double>& other) {
    return specular_irradiance({lit.scene, lit.caster, lit.direct_light}, lit.solution, points,
                               {.accuracy = 1e-3, .other_light = other});
  };
  const SpecularIrradiance alone = light({});
  const auto E = static_cast<double>(alone.irradiance.row(0).mean());
  const double other = 100.0 * E;
  const SpecularIrradiance beside = light({other});
  EXPECT_LE(std::sqrt(double{alone.variance[0]}), 1e-3 * E);
  EXPECT_LE(std::sqrt(double{beside.variance[0]}), 1e-3 * (E + other));
  EXPECT_GT(beside.variance[0], alone.variance[0]) << "fewer rays";
}

TEST(SpecularLight, ThroughAThinPaneAloneIsDirectLight) {
  Scene scene = SceneBuilder()
                    .square({.index_of_refraction = 1.5f, .thin = true}, {0, 0, 1}, up, 4.0)
                    .build();
  scene.lamps.push_back(point_lamp(scene, {0.0, 0.0, 2.0}, 5.0f));
  const TracedScene lit(scene);
  EXPECT_EQ(irradiance(lit, Vector3d::Zero(), up), 0.0);
  // Above the pane, looking down, the point sees the pane's reflection of the lamp.
  const double R = pane_reflectance(1.0, 1.5);
  const double expected = 5.0 * R / std::pow(1.0 + 0.5, 2);
  EXPECT_NEAR(irradiance(lit, {0, 0, 1.5}, -up), expected, of_newton * expected);
}

TEST(SpecularLight, HasTheSameBitsForAnyNumberOfThreads) {
  const TracedScene lit(over_a_mirror(0.8f, 0.1f)
                            .square({.exitance = 10.0f, .one_sided = true}, {0, 0, 2}, -up, 0.1)
                            .build());
  std::vector<GatherPoint> points;
  for (int i = 0; i < 5; ++i) points.push_back({.position = {0.2 * i, 0.1, 1.0}, .normal = -up});
  const auto all = [&] {
    return specular_irradiance({lit.scene, lit.caster, lit.direct_light}, lit.solution, points)
        .irradiance;
  };
  const BandArray many = all();
  const ThreadLimit one(1);
  EXPECT_TRUE((many == all()).all());
}

TEST(SpecularLight, WithoutMirrorsIsNone) {
  const TracedScene lit(SceneBuilder()
                            .square({.reflectance = 0.5f}, Vector3d::Zero(), up, 5.0)
                            .square({.exitance = 10.0f, .one_sided = true}, {0, 0, 2}, -up, 0.5)
                            .build());
  EXPECT_EQ(irradiance(lit, {0, 0, 1}, -up), 0.0);
}

}  // namespace
}  // namespace lightwell::specular_light_test
