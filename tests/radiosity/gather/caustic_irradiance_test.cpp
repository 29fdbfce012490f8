#include "radiosity/gather/caustic_irradiance.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>

#include "mesh/build_patches.h"
#include "tests/radiosity/test_scenes.h"

namespace lightwell::caustic_irradiance_test {
namespace {

using Eigen::Vector3d;

Material mirror_of(const Bands& bands, float share) {
  Material mirror = test::diffuse(bands, 0.0f);
  mirror.specular.setConstant(bands.count(), share);
  return mirror;
}

/// Solid angle of the square -1 to 1 in two directions, seen from `d` away with the foot at (a, b):
/// four rectangles that have a corner at the foot.
double solid_angle(double a, double b, double d) {
  double sum = 0.0;
  for (const double x : {1.0 - a, 1.0 + a}) {
    for (const double y : {1.0 - b, 1.0 + b}) {
      sum += std::atan(x * y / (d * std::sqrt(x * x + y * y + d * d)));
    }
  }
  return sum;
}

/// Light of an isotropic lamp of 1 W/sr at (x, y, z) that arrives at the mirror in x = end by way
/// of `most` reflections at most between the mirrors in x = end and x = -end, W.
double power_of_images(const Vector3d& lamp, double end, double own_share, double other_share,
                       int most) {
  double sum = 0.0;
  for (const bool is_own_first : {false, true}) {
    double image = lamp.x(), share = 1.0;
    for (int k = 0; k < most; ++k) {
      const bool is_own = (k % 2 == 0) == is_own_first;
      image = 2.0 * (is_own ? end : -end) - image;
      share *= is_own ? own_share : other_share;
      // Light comes from the image behind the other mirror.
      if (!is_own) sum += share * solid_angle(lamp.y(), lamp.z(), std::abs(image - end));
    }
  }
  return sum;
}

// Two mirrors face each other at the ends of a black cube of 2 m. All images of the lamp have their
// foot within both, so all of their light for a mirror passes the other one.
TEST(CausticIrradiance, OfAMirrorIsThatOfTheLampsImages) {
  constexpr float I = 3.0f, left = 0.8f, right = 0.5f;
  constexpr double end = 0.999;
  const Vector3d lamp(0.4, 0.3, -0.2);
  Scene scene;
  const int black = test::add_material(scene, test::diffuse(scene.bands, 0.0f));
  const int a = test::add_material(scene, mirror_of(scene.bands, left));
  const int b = test::add_material(scene, mirror_of(scene.bands, right));
  test::add_box(scene, {-1, -1, -1}, {1, 1, 1}, {black, black, black, black, black, black}, true);
  test::add_polygon(scene, "left", a, {{-end, -1, -1}, {-end, 1, -1}, {-end, 1, 1}, {-end, -1, 1}});
  test::add_polygon(scene, "right", b, {{end, -1, -1}, {end, -1, 1}, {end, 1, 1}, {end, 1, -1}});
  scene.lamps.push_back(
      {.name = "point", .position = lamp, .intensity = constant_spectrum(scene.bands, I)});
  const PatchMesh mesh = build_patches(scene, {.max_patch_size = 0.5});
  const ElementCaster caster(mesh);
  const DirectLight light(scene, mesh);
  constexpr int rays = 1 << 18, depth = 16;
  const BandArray E = caustic_irradiance({scene, caster, light}, rays, depth);
  ASSERT_GT(E.size(), 0);
  // Elements of a square are equal squares: their vertices' means add up to what they got.
  double at_left = 0.0, at_right = 0.0;
  for (int e = 0; e < mesh.element_count(); ++e) {
    const std::string& name = scene.surfaces[mesh.surface[mesh.patch[e]]].name;
    if (mesh.is_back[mesh.patch[e]] != 0 || (name != "left" && name != "right")) continue;
    for (int c = 0; c < mesh.corner_count(e); ++c) {
      const double power =
          double{E(mesh.corners[e][c], 0)} * mesh.element_area[e] / mesh.corner_count(e);
      (name == "left" ? at_left : at_right) += power;
    }
  }
  // A ray brings at most 0.8 of its power to a mirror at once, and 0.8 / (1 - 0.4) = 4/3 in all. So
  // the relative variance of the mean of N rays is at most 4/3 / (p N), with the share p of the
  // lamp's power that arrives. Four standard deviations. Light of the 17th image and on is less
  // than 0.4^8 of the first.
  const auto expect = [&](double found, double expected) {
    const double p = expected / (4.0 * std::numbers::pi * double{I});
    EXPECT_NEAR(found / expected, 1.0, 4.0 * std::sqrt(4.0 / 3.0 / (p * rays)));
  };
  expect(at_left, double{I} * power_of_images(lamp, -end, double{left}, double{right}, depth));
  expect(at_right, double{I} * power_of_images(lamp, end, double{right}, double{left}, depth));
}

}  // namespace
}  // namespace lightwell::caustic_irradiance_test
