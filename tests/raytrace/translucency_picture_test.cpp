// Pictures of thin sheets that pass light diffusely or straight on.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "raytrace/shading/shade.h"
#include "scene/optics.h"
#include "tests/raytrace/lit_scene.h"

namespace lightwell::translucency_picture_test {
namespace {

constexpr double pi = std::numbers::pi;
const Eigen::Vector3d up = Eigen::Vector3d::UnitZ();

double radiance(const TracedScene& lit, const Ray& ray, const RenderOptions& options = {}) {
  return static_cast<double>(RayTree(lit.scene, lit.caster, lit.direct_light, lit.solution, options)
                                 .trace(ray, 1)
                                 .radiance[0]);
}

// In a world of radiance 1 a sheet that sends all light on is invisible, whatever part of the light
// it reflects, passes diffusely, mirrors or passes straight. A dozen products of floats. The passes
// that gather do so by rays that all see radiance 1.
TEST(SheetInAFurnace, IsInvisible) {
  for (const Paint& paint :
       {Paint{.reflectance = 0.3f, .translucent = 0.7f}, Paint{.translucent = 1.0f},
        Paint{.reflectance = 0.2f, .translucent = 0.3f, .transparent = 0.5f},
        Paint{.specular = 0.2f, .translucent = 0.3f, .transparent = 0.5f},
        Paint{.transparent = 1.0f}}) {
    TracedScene lit(SceneBuilder()
                        .box({.exitance = static_cast<float>(pi)}, {-3, -3, -3}, {3, 3, 3}, true)
                        .square(paint, {0, 0, 0}, up, 1.0)
                        .build());
    lit.set_indirect([](const Eigen::Vector3d&) { return static_cast<float>(pi); });
    for (const Pass pass : {Pass::automatic, Pass::direct, Pass::interpolate, Pass::gather}) {
      for (const double degrees : {0.0, 60.0, 130.0}) {
        const double angle = degrees * pi / 180.0;
        const Eigen::Vector3d from(2.0 * std::sin(angle), 0.1, 2.0 * std::cos(angle));
        EXPECT_NEAR(
            radiance(lit, {.origin = from, .direction = -from.normalized()}, {.pass = pass}), 1.0,
            1e-5)
            << degrees << " degrees, pass " << static_cast<int>(pass);
      }
    }
  }
}

// The same for sheets under a coat, whose mirrored share goes from 4 % to nearly all with the
// angle: light that passes straight on makes way for it. The half of a perforated sheet that is not
// there passes all light. A smooth coat takes exact shares, so floats alone round.
TEST(SheetInAFurnace, IsInvisibleUnderACoatAtAnyAngle) {
  const auto mean = static_cast<float>(diffuse_fresnel(1.5));
  for (const bool has_holes : {false, true}) {
    const float covered = has_holes ? 0.5f : 1.0f;
    Scene scene = SceneBuilder()
                      .box({.exitance = static_cast<float>(pi)}, {-3, -3, -3}, {3, 3, 3}, true)
                      .square({.coat = 1.5f}, {0, 0, 0}, up, 1.0)
                      .build();
    Material& sheet = scene.materials.back();
    sheet.specular.setConstant(covered);
    sheet.transmittance = Spectrum::Constant(3, 0.3f * covered);
    sheet.regular_transmittance = Spectrum::Constant(3, 1.0f - covered + covered * (0.7f - mean));
    TracedScene lit(scene);
    lit.set_indirect([](const Eigen::Vector3d&) { return static_cast<float>(pi); });
    for (const double degrees : {0.0, 60.0, 80.0, 88.0}) {
      const double angle = degrees * pi / 180.0;
      const Eigen::Vector3d from(2.0 * std::sin(angle), 0.1, 2.0 * std::cos(angle));
      EXPECT_NEAR(radiance(lit, {.origin = from, .direction = -from.normalized()}), 1.0, 1e-5)
          << degrees << (has_holes ? " with holes" : "");
    }
  }
}

// A sheet, 1 m below a lamp of 5 W/sr; its lower side shows L = tau / pi E of the upper one.
constexpr float tau = 0.4f;
Scene sheet_under_lamp(const Paint& paint) {
  Scene scene = SceneBuilder()
                    .square(paint, {0, 0, 0}, up, 1.0)
                    .square({.reflectance = 0.5f}, {0, 0, -2}, up, 1.0)
                    .build();
  scene.lamps = {
      {.name = "lamp", .position = {0.3, 0, 1}, .intensity = Spectrum::Constant(3, 5.0f)}};
  return scene;
}

double irradiance_of_lamp(const Eigen::Vector3d& point) {
  const Eigen::Vector3d to = Eigen::Vector3d(0.3, 0, 1) - point;
  return 5.0 * to.z() / std::pow(to.norm(), 3);
}

// A hit is known to 1e-7 of its distance, which moves E by 1e-6; some ten products of floats.
TEST(Sheet, GlowsBelowALamp) {
  for (const bool coated : {false, true}) {
    Paint paint{.reflectance = 0.3f, .translucent = tau};
    if (coated) paint.coat = 1.5f;
    const TracedScene lit(sheet_under_lamp(paint), 0.25);
    for (const double degrees : {0.0, 50.0}) {
      const double angle = degrees * pi / 180.0;
      const Eigen::Vector3d point(0.1, 0.2, 0.0), down(0, std::sin(angle), -std::cos(angle));
      const Eigen::Vector3d to = Eigen::Vector3d(0.3, 0, 1) - point;
      double exact = double{tau} / pi * irradiance_of_lamp(point);
      if (coated) {
        const CoatedBase base(lit.scene.materials[0]);
        exact *= base.factor(to.z() / to.norm()) * base.factor(std::cos(angle));
      }
      EXPECT_NEAR(radiance(lit, {.origin = point + down, .direction = -down}) / exact, 1.0, 1e-5)
          << degrees << (coated ? " coated" : "");
    }
  }
}

// Seen through a sheet, the floor has tau_r of the radiance that tau_r of the lamp's light gives.
TEST(Sheet, ShowsWhatLiesBehind) {
  constexpr float straight = 0.25f;
  const TracedScene lit(sheet_under_lamp({.transparent = straight}), 0.5);
  const Eigen::Vector3d point(0.1, 0.2, -2.0);
  const double exact = double{straight} * double{straight} * 0.5 / pi * irradiance_of_lamp(point);
  const Eigen::Vector3d eye(0.1, 0.3, 0.5);
  EXPECT_NEAR(radiance(lit, {.origin = eye, .direction = (point - eye).normalized()}) / exact, 1.0,
              1e-5);
}

// A rough mirror that also passes light straight shows both: the world of radiance 1 behind it, and
// its mirrored share of the same world. Samples of its lobe all see radiance 1.
TEST(Sheet, PassesLightStraightBesideARoughMirror) {
  TracedScene lit(
      SceneBuilder()
          .box({.exitance = static_cast<float>(pi)}, {-3, -3, -3}, {3, 3, 3}, true)
          .square({.specular = 0.4f, .roughness = 0.2f, .transparent = 0.6f}, {0, 0, 0}, up, 1.0)
          .build());
  lit.set_indirect([](const Eigen::Vector3d&) { return static_cast<float>(pi); });
  const Eigen::Vector3d from(1.0, 0.1, 1.5);
  EXPECT_NEAR(radiance(lit, {.origin = from, .direction = -from.normalized()}), 1.0, 1e-3);
}

}  // namespace
}  // namespace lightwell::translucency_picture_test
