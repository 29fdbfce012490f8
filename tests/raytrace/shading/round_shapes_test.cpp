// Cylinders, cones and discs in pictures.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "raytrace/shading/shade.h"
#include "tests/raytrace/lit_scene.h"

namespace lightwell::round_shapes_test {
namespace {

using Eigen::Vector3d;
constexpr float pi_f = std::numbers::pi_v<float>;

double radiance(const TracedScene& lit, const Ray& ray, const RenderOptions& options = {}) {
  const RayTree tree(lit.scene, lit.caster, lit.direct_light, lit.solution, options);
  return static_cast<double>(tree.trace(ray, 1).radiance.mean());
}

Frustum rod(double radius) {
  return {.base = {0, 0, -3}, .height = 6.0, .base_radius = radius, .top_radius = radius};
}

/// A ray at the distance b from the axis of a rod of glass turns by theta - theta' (Snell's law)
/// where it enters and where it leaves, so it crosses the line through the axis behind the rod at
/// the distance r sin(theta) / sin(2 (theta - theta')) from the axis. A small lamp there is seen,
/// and is not by rays that pass it by a tenth of its radius.
TEST(RoundShapes, ARodOfGlassFocusesAsSnellSays) {
  constexpr double r = 0.5, n = 1.5;
  for (const double b : {0.01, 0.1, 0.25, 0.4}) {
    const double theta = std::asin(b / r), inside = std::asin(b / (r * n));
    const double turn = 2.0 * (theta - inside);
    const double crossing = b / std::sin(turn);
    // Paraxially the focal length is n r / (2 (n - 1)). The next term of the series in b / r is
    // less than (b / r)^2 of it.
    if (b == 0.01) {
      constexpr double focal = n * r / (2.0 * (n - 1.0)), next = 0.02 * 0.02 * focal;
      EXPECT_NEAR(crossing, focal, next);
    }
    // The lamp lies a metre behind the crossing on the ray, which runs down from y = b.
    const Vector3d way(std::cos(turn), -std::sin(turn), 0);
    const Vector3d lamp = Vector3d(crossing, 0, 0) + way;
    constexpr double size = 1e-3;
    const TracedScene lit(SceneBuilder()
                              .add({.index_of_refraction = 1.5f}, rod(r))
                              .sphere({.exitance = pi_f}, lamp, size)
                              .build());
    // Rays shifted along the axis leave by as much; the rod does not bend them there.
    const auto seen_at = [&](double off) {
      return radiance(lit, {.origin = {-2, b, off * size}, .direction = {1, 0, 0}});
    };
    // A surface mirrors 0.065 at the steepest, 53 degrees (Fresnel), so two pass 0.87 or more.
    EXPECT_GT(seen_at(0.0), 0.87) << b;
    EXPECT_GT(seen_at(0.9), 0.87) << b;
    EXPECT_EQ(seen_at(1.1), 0.0) << b;
    EXPECT_EQ(seen_at(-1.1), 0.0) << b;
  }
}

/// A closed body of a cylinder, a cone and a disc. After k internal reflections the share of the
/// deepest branch is (1 - R) R^k < 1 / (e k) for any R, as in
/// GlassSphereInAUniformWorldIsInvisible. Branches of less than 1e-6 are cut off, a hundred of them
/// at most.
TEST(RoundShapes, AGlassBodyInAUniformWorldIsInvisible) {
  constexpr int depth = 500;
  const Paint glass{.index_of_refraction = 1.5f};
  SceneBuilder builder;
  builder.box({.exitance = pi_f}, {-3, -3, -3}, {3, 3, 3}, true);
  // One material for all surfaces of the body.
  Scene scene =
      builder
          .add(glass, Frustum{.base = {0, 0, -1}, .height = 1.5, .base_radius = 1, .top_radius = 1})
          .build();
  const int of_glass = scene.surfaces.back().material;
  scene.surfaces.push_back(
      {.name = "tip",
       .material = of_glass,
       .shape = Frustum{.base = {0, 0, 0.5}, .height = 0.8, .base_radius = 1, .top_radius = 0}});
  scene.surfaces.push_back({.name = "foot",
                            .material = of_glass,
                            .shape = Frustum{.base = {0, 0, -1},
                                             .height = 0.0,
                                             .base_radius = 1.0,
                                             .top_radius = 0.0,
                                             .inward = true}});
  const TracedScene lit(scene);
  for (int i = 0; i <= 200; ++i) {
    const double off = 1.05 * i / 200.0;
    for (const Vector3d& way : {Vector3d(0, 0, -1), Vector3d(-0.6, 0, -0.8)}) {
      const Ray ray{.origin = Vector3d(off, 0.1, 0) - 2.4 * way, .direction = way};
      EXPECT_NEAR(radiance(lit, ray, {.max_depth = depth, .min_contribution = 1e-6f}), 1.0,
                  1.0 / (std::numbers::e * depth) + 100 * 1e-6)
          << off << " " << way.transpose();
    }
  }
}

/// The mirror image of a point lamp in a cylinder lies on the line by the law of reflection about
/// the exact normal.
TEST(RoundShapes, AMirrorConeReflectsAboutItsNormal) {
  const Frustum cone{.base = {0, 0, -1}, .height = 2.0, .base_radius = 1.0, .top_radius = 0.0};
  const Vector3d on(0.5 * std::cos(0.7), 0.5 * std::sin(0.7), 0.0);
  const Vector3d normal = Vector3d(2.0 * on.x() / 0.5, 2.0 * on.y() / 0.5, 1.0).normalized();
  const Vector3d eye = on + 2.0 * (normal + 0.4 * Vector3d::UnitZ()).normalized();
  const Vector3d in = (on - eye).normalized();
  const Vector3d lamp = on + 3.0 * (in - 2.0 * in.dot(normal) * normal);
  constexpr double size = 1e-3;
  const TracedScene lit(
      SceneBuilder().add({.specular = 1.0f}, cone).sphere({.exitance = pi_f}, lamp, size).build());
  // The product of a few floats.
  constexpr double rounding = 4 * double{std::numeric_limits<float>::epsilon()};
  EXPECT_NEAR(radiance(lit, {.origin = eye, .direction = in}), 1.0, rounding);
}

}  // namespace
}  // namespace lightwell::round_shapes_test
