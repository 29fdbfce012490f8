// Rays that meet cylinders, cones and rings.
#include "scene/rays/ray_caster.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "scene/sampling.h"

namespace lightwell::cast_round_shapes_test {
namespace {

using Eigen::Vector3d;

Hit closest(const RayCaster& caster, const Ray& ray) {
  Hit hit;
  caster.closest_hits({&ray, 1}, {&hit, 1});
  return hit;
}

RayCaster caster_of(const RoundShape& shape) {
  return RayCaster(CastGeometry{.round_shapes = {shape}, .group = {0}});
}

const Frustum tube{.base = {1, 0, 0}, .height = 2.0, .base_radius = 0.5, .top_radius = 0.5};

// Ways up to 4 m of a few roundings each, which the root of 0.05 m^2 or more hardly amplifies.
constexpr double rounding = 8 * 0x1p-53 * 4.0;  // 3.6e-15

TEST(CastRoundShapes, ACylinderIsMetWhereItsCircleIs) {
  const RayCaster caster = caster_of(tube);
  // At the height 1 the cross-section is a circle of radius 0.5 about x = 1.
  for (double y = -0.45; y < 0.5; y += 0.1) {
    const Hit hit = closest(caster, {.origin = {-3, y, 1.0}, .direction = {2, 0, 0}});
    EXPECT_NEAR(hit.t, 0.5 * (4.0 - std::sqrt(0.25 - y * y)), rounding);
    EXPECT_FALSE(hit.from_back);
    const Hit from_within = closest(caster, {.origin = {1, y, 1.0}, .direction = {2, 0, 0}});
    EXPECT_NEAR(from_within.t, 0.5 * std::sqrt(0.25 - y * y), rounding);
    EXPECT_TRUE(from_within.from_back);
  }
  // Over the rim and through the open ends.
  EXPECT_LT(closest(caster, {.origin = {-3, 0, 2.001}, .direction = {1, 0, 0}}).primitive, 0);
  EXPECT_LT(closest(caster, {.origin = {1.2, 0.1, -3}, .direction = {0, 0, 1}}).primitive, 0);
  EXPECT_GE(closest(caster, {.origin = {1.0, 0.1, -3}, .direction = {0, 0.1, 1}}).primitive, 0);
}

TEST(CastRoundShapes, RaysLeaveTheirOwnOrigin) {
  const RayCaster caster = caster_of(tube);
  for (const double off : {0.0, 1e-9, -1e-9}) {
    const Vector3d on(1.5 + off, 0, 1);
    EXPECT_LT(
        closest(caster, {.origin = on, .direction = {1, 0.3, 0.2}, .origin_group = 0}).primitive,
        0);
    const Hit across = closest(caster, {.origin = on, .direction = {-1, 0, 0}, .origin_group = 0});
    EXPECT_NEAR(across.t, 1.0 + off, rounding);
    EXPECT_TRUE(across.from_back);
  }
}

TEST(CastRoundShapes, ARingIsMetBetweenItsCircles) {
  const RayCaster caster = caster_of(Frustum{.height = 0.0, .base_radius = 1.0, .top_radius = 0.4});
  for (const double x : {0.1, 0.39, 0.41, 0.7, 0.99, 1.01}) {
    const Hit hit = closest(caster, {.origin = {x, 0, 2}, .direction = {0, 0, -4}});
    EXPECT_EQ(hit.primitive >= 0, x > 0.4 && x < 1.0) << x;
    if (hit.primitive < 0) continue;
    EXPECT_EQ(hit.t, 0.5);
    EXPECT_FALSE(hit.from_back);
    EXPECT_TRUE(closest(caster, {.origin = {x, 0, -2}, .direction = {0, 0, 4}}).from_back);
  }
}

/// Rays in all directions against the same shape as 4096 quadrilaterals with corners on it, which
/// lie within r (1 - cos(pi / 4096)) = 3e-7 r of it. Rays that pass a rim within 1e-6 m, this and
/// the rounding of floats, are 4 pi 1e-6 of a cross-section of 2 m^2 or more: a tenth of a ray, and
/// more than two with a probability of 2e-4. A shape as flat as a disc covers half of the ball
/// around it on average (Cauchy), of which two thirds are asked for.
void expect_as_finely_cut(const Frustum& f, const Vector3d& shift) {
  constexpr int sides = 4096;
  Frustum moved = f;
  moved.base += shift;
  CastGeometry cut;
  const LongitudeFrame frame = longitudes(moved);
  for (int i = 0; i < sides; ++i) {
    const double phi = 2.0 * std::numbers::pi * i / sides;
    const Vector3d way = std::cos(phi) * frame.zero + std::sin(phi) * frame.quarter;
    cut.vertices.push_back(moved.base + f.base_radius * way);
    cut.vertices.push_back(moved.base + f.height * f.axis + f.top_radius * way);
    const int a = 2 * i, b = 2 * ((i + 1) % sides);
    cut.quads.push_back({a, b, b + 1, a + 1});
    cut.group.push_back(i);
  }
  const RayCaster exact = caster_of(moved), fine(cut);
  constexpr int rays = 20000;
  const SobolPoints sobol(rays);
  int differ = 0, met = 0;
  for (int i = 0; i < rays; ++i) {
    const Eigen::Array4d u = sobol.point(i, 7).cast<double>();
    const auto on_ball = [](double z, double turn) {
      const double r = std::sqrt(1.0 - z * z), phi = 2.0 * std::numbers::pi * turn;
      return Vector3d(r * std::cos(phi), r * std::sin(phi), z);
    };
    const Sphere ball = ball_around(moved);
    const Vector3d from = ball.center + 1.5 * ball.radius * on_ball(2.0 * u[0] - 1.0, u[1]);
    const Vector3d to = ball.center + 0.9 * ball.radius * on_ball(2.0 * u[2] - 1.0, u[3]);
    const Ray ray{.origin = from, .direction = to - from};
    const Hit a = closest(exact, ray), b = closest(fine, ray);
    const bool same = (a.primitive < 0) == (b.primitive < 0);
    if (!same || (a.primitive >= 0 && std::abs(a.t - b.t) > 1e-3)) {
      ++differ;
      continue;
    }
    if (a.primitive < 0) continue;
    ++met;
    EXPECT_EQ(a.from_back, b.from_back);
    const Vector3d at = ray.origin + a.t * ray.direction;
    // Thirty roundings of coordinates up to the shift and the shape's own 4 m.
    EXPECT_LT((nearest_on(moved, at) - at).norm(), 30 * 0x1p-53 * (4.0 + shift.norm()));
  }
  EXPECT_GT(met, rays / 3);
  EXPECT_LE(differ, 2);
}

TEST(CastRoundShapes, FrustumsAreMetWhereFineFacetsAre) {
  const Vector3d axis = Vector3d(1, -2, 2) / 3.0;
  for (const Vector3d& shift : {Vector3d(0, 0, 0), Vector3d(300, -200, 50)}) {
    for (const bool inward : {false, true}) {
      expect_as_finely_cut({.axis = axis, .height = 1.5, .inward = inward}, shift);
      expect_as_finely_cut({.axis = axis, .top_radius = 0.4, .inward = inward}, shift);
      expect_as_finely_cut({.axis = axis, .base_radius = 0.3, .inward = inward}, shift);
      expect_as_finely_cut({.axis = axis, .height = 0.2, .top_radius = 0.0, .inward = inward},
                           shift);
    }
  }
}

}  // namespace
}  // namespace lightwell::cast_round_shapes_test
