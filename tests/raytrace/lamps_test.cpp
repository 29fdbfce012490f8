// Pictures of rooms lit by lamps without surface.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "radiosity/solve.h"
#include "raytrace/probe.h"
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

}  // namespace
}  // namespace lightwell::lamps_test
