// Pictures of rooms lit by lamps without surface.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "radiosity/solve.h"
#include "raytrace/readings/probe.h"
#include "raytrace/render.h"
#include "tests/radiosity/test_scenes.h"

namespace lightwell::lamps_test {
namespace {

Scene room(const Material* floor = nullptr) {
  Scene scene;
  const int grey = test::add_material(scene, test::diffuse(scene.bands, 0.5f));
  int below = grey;
  if (floor) below = test::add_material(scene, *floor);
  test::add_box(scene, {0, 0, 0}, {4, 5, 3}, {grey, grey, grey, grey, below, grey}, true);
  return scene;
}

Lamp point_lamp(const Scene& scene) {
  return {.name = "bulb",
          .position = {2.0, 3.0, 2.0},
          .intensity = constant_spectrum(scene.bands, 10.0f)};
}

SolveOptions quick() {
  SolveOptions options;
  options.mesh.max_patch_size = 0.5;
  options.form_factors.rays_per_patch = 256;
  options.gather.rays = 256;
  options.error_points = 64;
  return options;
}

Camera camera() {
  const Eigen::Vector3d direction = Eigen::Vector3d(0.0, 1.0, -0.45).normalized();
  const Eigen::Vector3d up = Eigen::Vector3d(0.0, 0.45, 1.0).normalized();
  return {.name = "c",
          .position = {2.0, 0.3, 1.7},
          .direction = direction,
          .up = up,
          .fov_degrees = 70.0,
          .width = 48,
          .height = 36};
}

TEST(LampPictures, AllPassesAgreeAndProbesWithThem) {
  Scene scene = room();
  scene.lamps = {point_lamp(scene)};
  const SolvedScene solved = solve_scene(scene, quick());
  const ElementCaster caster(solved.mesh);
  const DirectLight light(scene, solved.mesh);
  std::vector<double> means;
  for (const Pass pass : {Pass::interpolate, Pass::direct, Pass::gather}) {
    RenderOptions options;
    options.pass = pass;
    const Image image = render(scene, caster, light, solved.solution, camera(), options);
    means.push_back(image.radiance.cast<double>().mean());
  }
  std::printf("means: %.5f interpolated, %.5f direct, %.5f gathered\n", means[0], means[1],
              means[2]);
  // Gathers of 256 rays have noise of a twentieth in reflected light, 0.1 % in the mean of 1728
  // pixels. Linear interpolation between vertices adds (element / room)^2 = (0.25 / 4)^2.
  EXPECT_NEAR(means[0] / means[2], 1.0, 0.005);
  EXPECT_NEAR(means[1] / means[2], 1.0, 0.005);

  const std::vector<Probe> probes = {{.position = {1.0, 1.0, 0.0}}, {.position = {3.0, 3.7, 0.0}}};
  const BandArray gathered =
      probe_irradiance(scene, caster, light, solved.solution, probes, {.rays = 1024});
  const BandArray interpolated = interpolate_irradiance(caster, solved.solution, probes);
  // The tolerance is (0.25 / 4)^2 for interpolation, and the noise of 1024 stratified rays.
  EXPECT_LT(((gathered - interpolated) / gathered).abs().maxCoeff(), 0.01f);
}

// The highlight of a lamp in a rough mirror is that of a small ball of the same intensity.
TEST(LampPictures, HighlightIsThatOfASmallBall) {
  Material glossy = test::diffuse(rgb_bands(), 0.0f);
  glossy.specular = constant_spectrum(rgb_bands(), 0.8f);
  glossy.specular_roughness = 0.3f;
  const auto mean = [&](bool with_ball) {
    Scene scene = room(&glossy);
    const Lamp lamp = point_lamp(scene);
    if (with_ball) {
      // I = L pi r^2 and M = pi L.
      const double r = 0.02;
      const int shining = test::add_material(
          scene, test::diffuse(scene.bands, 0.0f, static_cast<float>(10.0 / (r * r))));
      scene.surfaces.push_back({.name = "ball",
                                .material = shining,
                                .shape = Sphere{.center = lamp.position, .radius = r}});
    } else {
      scene.lamps = {lamp};
    }
    const SolvedScene solved = solve_scene(scene, quick());
    const ElementCaster caster(solved.mesh);
    const DirectLight light(scene, solved.mesh);
    const Image image = render(scene, caster, light, solved.solution, camera());
    return image.radiance.bottomRows(48 * 18).cast<double>().mean();  // the floor
  };
  // The ball occludes nothing and has a radius of 0.02 m at 1 m or more: (0.02 / 1)^2 / 4 by its
  // size, and the noise of a highlight sampled at random in 864 pixels, 0.2 / sqrt(864).
  EXPECT_NEAR(mean(false) / mean(true), 1.0, 0.007);
}

// A room with a lamp of 0.4 m x 0.4 m below its ceiling, aimed down, and a mirror as its floor.
Scene room_with_panel(const IntensityShape& shape) {
  Scene scene;
  Material mirror = test::diffuse(scene.bands, 0.0f);
  mirror.specular = constant_spectrum(scene.bands, 0.5f);
  const int grey = test::add_material(scene, test::diffuse(scene.bands, 0.5f));
  const int floor = test::add_material(scene, mirror);
  test::add_box(scene, {0, 0, 0}, {4, 4, 3}, {grey, grey, grey, grey, floor, grey}, true);
  scene.lamps = {{.name = "panel",
                  .position = {2, 2, 2.8},
                  .axes = lamp_axes(-Eigen::Vector3d::UnitZ()),
                  .intensity = constant_spectrum(scene.bands, 8.0f),
                  .shape = shape,
                  .opening = {.along_c0 = 0.4, .along_c90 = 0.4}}};
  return scene;
}

// The middle pixel of a narrow picture.
float middle_of(const Scene& scene, const SolvedScene& solved, const Eigen::Vector3d& from,
                const Eigen::Vector3d& to) {
  Camera eye{.position = from, .direction = (to - from).normalized(), .fov_degrees = 0.01};
  eye.up = eye.direction.unitOrthogonal();
  eye.width = eye.height = 1;
  const Image image =
      render(scene, ElementCaster(solved.mesh), DirectLight(scene, solved.mesh), solved.solution,
             eye, {.pass = Pass::interpolate, .photons = 0, .max_subdivision = 0});
  return image.radiance.mean();
}

TEST(LampPictures, ShowTheOpeningAsBrightAsItsIntensityOverItsArea) {
  Scene scene = room_with_panel({});
  const SolvedScene solved = solve_scene(scene, quick());
  const Eigen::Vector3d panel(2, 2, 2.8);
  // A pixel is the mean of its corners. A float rounds by 6e-8; intensity, area, radiance, mirror,
  // weights and sums of four corners are some 30 operations: 2e-6, doubled for the caster's floats.
  constexpr float rounding = 4e-6f;
  constexpr float L = 8.0f / 0.16f;  // straight below: I / A
  EXPECT_NEAR(middle_of(scene, solved, {2, 2, 1}, panel), L, rounding * L);
  // At 45 degrees the opening looks smaller by the cosine, and the intensity is the same. Over half
  // a pixel of 0.01 degrees, 8.7e-5 rad, the cosine changes by that share.
  constexpr float half_pixel = 8.7e-5f;
  const float oblique = L / std::cos(std::numbers::pi_v<float> / 4.0f);
  EXPECT_NEAR(middle_of(scene, solved, {0.9, 2, 1.7}, panel), oblique, half_pixel * oblique);
  // The mirror of the floor shows it, half as bright: at (2, 2, -2.8).
  EXPECT_NEAR(middle_of(scene, solved, {2, 2, 1}, {2, 2, -2.8}), 0.5f * L, rounding * L);
  scene.lamps[0].visible = false;
  // Straight above a point lamp at a distance of d = 0.2 m the ceiling has rho I / (pi d^2) = 32 by
  // direct light; an opening gives less. Reflected light adds at most E / pi of a closed room with
  // reflectance 0.5, Phi rho / (A (1 - rho) pi) = 4 pi 8 / (80 pi) = 0.4.
  EXPECT_LT(middle_of(scene, solved, {2, 2, 1}, panel), 32.4f);
}

TEST(LampPictures, ShowAnOpeningInThePlaneOfItsCeiling) {
  Scene scene = room_with_panel({});
  scene.lamps[0].position.z() = 3.0;
  const SolvedScene solved = solve_scene(scene, quick());
  constexpr float L = 8.0f / 0.16f;
  for (const double x : {1.85, 1.95, 2.05, 2.15}) {
    const Eigen::Vector3d from(x, 2.1, 1.0), to(x, 2.1, 3.0);
    EXPECT_NEAR(middle_of(scene, solved, from, to), L, 4e-6f * L) << "rounding as above";
  }
}

TEST(LampPictures, ShowNoOpeningThatSendsNoLightToTheEye) {
  Scene scene = room_with_panel(SpotCone{.inner = 0.5, .outer = 0.7});
  const SolvedScene solved = solve_scene(scene, quick());
  const float ceiling = middle_of(scene, solved, {0.3, 2, 2.5}, {2, 2, 2.8});
  scene.lamps[0].visible = false;
  EXPECT_EQ(middle_of(scene, solved, {0.3, 2, 2.5}, {2, 2, 2.8}), ceiling);
}

}  // namespace
}  // namespace lightwell::lamps_test
