#include "radiosity/emitters/solid_angle_sampler.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

#include "mesh/build_patches.h"
#include "mesh/elements/element_caster.h"
#include "radiosity/direct_light/direct_light.h"
#include "scene/sampling.h"
#include "tests/radiosity/test_scenes.h"

namespace lightwell::solid_angle_sampler_test {
namespace {

using Eigen::Vector3d;

// A window of 3 m x 5 m that shines upwards, and what is to be hung above it.
struct Window {
  Scene scene{};
  PatchMesh mesh{};
};

Window window_with(const Loop& slat) {
  Window w;
  const int lamp = test::add_material(w.scene, test::diffuse(w.scene.bands, 0.0f, 1.0f));
  Material both = test::diffuse(w.scene.bands, 0.0f);
  both.one_sided = false;
  const int black = test::add_material(w.scene, both);
  test::add_polygon(w.scene, "window", lamp, {{0, 0, 0}, {3, 0, 0}, {3, 5, 0}, {0, 5, 0}});
  if (!slat.empty()) test::add_polygon(w.scene, "slat", black, slat);
  // A far wall keeps the window a small part of the scene.
  test::add_polygon(w.scene, "far", black, {{-9, -9, 9}, {9, -9, 9}, {9, 9, 9}, {-9, 9, 9}});
  w.mesh = build_patches(w.scene, {.max_patch_size = 1.0, .elements_per_patch_edge = 1});
  return w;
}

TEST(SolidAngleSampler, PlacesAreEvenInSolidAngle) {
  const Window w = window_with({});
  const DirectLight light(w.scene, w.mesh);
  const Emitter& window = light.emitters().at(0);
  const Vector3d point{0.9, 1.2, 0.1}, normal = Vector3d(0.3, 0.2, -0.9).normalized();
  const SolidAngleSampler sampler(window, point);
  ASSERT_FALSE(sampler.empty());
  // Twice the integral of Lambert's cosine over a rectangle whose corner is below the point.
  const auto corner = [&](double x, double y) {
    const double z = point.z();
    return std::atan(x * y / (z * std::sqrt(x * x + y * y + z * z)));
  };
  const double left = point.x(), right = 3 - left, below = point.y(), above = 5 - below;
  const double all =
      corner(left, below) + corner(right, below) + corner(left, above) + corner(right, above);
  constexpr int count = 4096;
  const SobolPoints sobol(count);
  double cosines = 0.0;
  int lower_left = 0;
  for (int i = 0; i < count; ++i) {
    const Eigen::Array4d u = sobol.point(i, 5).cast<double>();
    const Vector3d to = sampler.to_point(u[0], u[1]), at = point + to;
    ASSERT_NEAR(at.z(), 0.0, 1e-16);  // two roundings of 0.1
    // Arcs' cosines are known to 1e-16 each, and places to about the distance times as much.
    ASSERT_TRUE(at.x() > -1e-14 && at.x() < 3 + 1e-14 && at.y() > -1e-14 && at.y() < 5 + 1e-14);
    cosines += std::max(0.0, to.normalized().dot(normal)) / count;
    lower_left += at.x() < point.x() && at.y() < point.y() ? 1 : 0;
  }
  // Stratified in two dimensions: off by about n^(-3/4) = 0.002 where an edge cuts through.
  EXPECT_NEAR(static_cast<double>(lower_left) / count, corner(left, below) / all, 8e-4);
  const double F = std::abs(point_to_polygon(point, normal, window.loops));
  std::printf("F by places %.6f, exact %.6f\n", cosines * all / std::numbers::pi, F);
  EXPECT_NEAR(cosines * all / std::numbers::pi / F, 1.0, 2.5e-4);  // smooth: one of 4096 places
}

TEST(SolidAngleSampler, IsNothingFromAfarOrInThePlane) {
  const Window w = window_with({});
  const DirectLight light(w.scene, w.mesh);
  const Emitter& window = light.emitters().at(0);
  EXPECT_TRUE(SolidAngleSampler(window, {1.5, 2.5, 6.0}).empty());
  EXPECT_TRUE(SolidAngleSampler(window, {8.0, 2.5, 1.0}).empty());  // beside it
  EXPECT_TRUE(SolidAngleSampler(window, {1.5, 2.5, 0.0}).empty());
  EXPECT_FALSE(SolidAngleSampler(window, {1.5, 2.5, 2.0}).empty());
}

// 9 cm in front of the window, with a slat's edge half-way between.
TEST(SolidAngleSampler, WhatASlatHidesOfAWindowIsFoundWithFewRays) {
  constexpr double height = 0.09, edge = 1.45;
  const Window w = window_with(
      {{edge, -9, height / 2}, {8, -9, height / 2}, {8, 9, height / 2}, {edge, 9, height / 2}});
  const ElementCaster caster(w.mesh);
  const DirectLight light(w.scene, w.mesh);
  const Vector3d point{1.5, 2.5, height}, normal{0, 0, -1};
  const double x = point.x() + 2 * (edge - point.x());  // of the edge, seen on the window
  const Loop seen{{0, 0, 0}, {x, 0, 0}, {x, 5, 0}, {0, 5, 0}};
  const double exact = std::abs(point_to_polygon(point, normal, seen));
  double squares = 0.0;
  constexpr int tries = 64;
  for (int i = 0; i < tries; ++i) {
    const double F = light.form_factor(light.emitters()[0], caster,
                                       {.at = {point, normal},
                                        .key = random_key(i, 3),
                                        .shadows = {.min_rays = 64, .max_rays = 64}});
    squares += std::pow(F / exact - 1.0, 2) / tries;
  }
  // A straight edge crosses 2 sqrt(64) of the 64 rays' cells at most, each of which is off by 0.3:
  // 1.9 % of all that the window gives, of which 0.128 is seen: 15 %. (Places even in area: 260 %.)
  std::printf("F %.4f of %.4f, off by %.3f RMS\n", exact,
              light.unoccluded_form_factor(light.emitters()[0], {point, normal}),
              std::sqrt(squares));
  EXPECT_LT(std::sqrt(squares), 0.15);
}

}  // namespace
}  // namespace lightwell::solid_angle_sampler_test
