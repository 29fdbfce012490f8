// Luminaires' bodies in pictures.
#include "raytrace/shading/visible_lamps.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>

#include "radiosity/solve.h"
#include "raytrace/render.h"
#include "tests/radiosity/test_scenes.h"

namespace lightwell::visible_lamps_test {
namespace {

constexpr float inv_pi = std::numbers::inv_pi_v<float>;
const Eigen::Vector3d middle(2, 2, 1.5);

/// A furnace of radiance 2 / pi: all sides of a room emit M = 1 and give back half of what arrives,
/// L = M / pi + L / 2; the floor mirrors it. Of the lamp's light there is none unless `candela`.
Scene furnace(float candela = 0.0f, float floor_roughness = 0.0f) {
  Scene scene;
  const int grey = test::add_material(scene, test::diffuse(scene.bands, 0.5f, 1.0f));
  Material mirror = test::diffuse(scene.bands, 0.0f, 1.0f);
  mirror.specular = constant_spectrum(scene.bands, 0.5f);
  mirror.specular_roughness = floor_roughness;
  const int floor = test::add_material(scene, mirror);
  test::add_box(scene, {0, 0, 0}, {4, 4, 3}, {grey, grey, grey, grey, floor, grey}, true);
  Lamp lamp{.name = "pendant",
            .position = middle,
            .axes = lamp_axes(-Eigen::Vector3d::UnitZ()),
            .intensity = constant_spectrum(scene.bands, candela),
            .shape = SpotCone{.inner = 1.0, .outer = 1.0}};
  lamp.opening = {.along_c0 = 0.4, .along_c90 = 0.4};
  lamp.body = {.along_c0 = 0.6, .along_c90 = 0.6, .height = 0.2};
  scene.lamps = {lamp};
  return scene;
}

SolvedScene solved(const Scene& scene) {
  SolveOptions options;
  options.mesh.max_patch_size = 1.0;
  options.form_factors.rays_per_patch = 1024;
  options.gather.rays = 256;
  options.error_points = 16;
  return solve_scene(scene, options);
}

Image picture(const Scene& scene, const SolvedScene& room, const Camera& eye,
              RenderOptions options = {}) {
  options.photons = 0;
  return render(scene, ElementCaster(room.mesh), DirectLight(scene, room.mesh), room.solution, eye,
                options);
}

Camera looking(const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
  Camera eye{.position = from, .direction = (to - from).normalized(), .fov_degrees = 0.01};
  eye.up = eye.direction.unitOrthogonal();
  eye.width = eye.height = 1;
  return eye;
}

float seen(const Scene& scene, const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
  return picture(scene, solved(scene), looking(from, to), {.pass = Pass::interpolate})
      .radiance.mean();
}

// The furnace's solution converges to 1e-3 of its light.
constexpr float converged = 1e-3f;

// Products and quotients of a few floats, as a share of the result.
constexpr float rounding = 4 * std::numeric_limits<float>::epsilon();

TEST(VisibleLamps, BodiesReflectHalfOfAFurnace) {
  const Scene scene = furnace();
  const float body = 0.5f * 2.0f * inv_pi;
  EXPECT_NEAR(seen(scene, {0.2, 2, 1.6}, middle + Eigen::Vector3d(-0.3, 0, 0.1)), body,
              converged * body);
  EXPECT_NEAR(seen(scene, {1.8, 2, 2.9}, middle + Eigen::Vector3d(0, 0, 0.2)), body,
              converged * body);
  // The mirror shows the rim of the body's lower side, beside the opening, at z = -1.5.
  const float mirrored = inv_pi + 0.5f * body;
  EXPECT_NEAR(seen(scene, {2.25, 2, 1.2}, {2.25, 2, -1.5}), mirrored, converged * mirrored);
}

TEST(VisibleLamps, HiddenOnesAreNotSeen) {
  Scene scene = furnace();
  scene.lamps[0].visible = false;
  EXPECT_NEAR(seen(scene, {0.2, 2, 1.6}, middle), 2.0f * inv_pi, converged * 2.0f * inv_pi);
}

/// I / A at every place of the opening, from below; from above its body alone.
TEST(VisibleLamps, OpeningsAreSeenBeforeTheirBody) {
  const Scene scene = furnace(8.0f);
  const SolvedScene room = solved(scene);
  const VisibleLamps lamps(scene, ElementCaster(room.mesh), DirectLight(scene, room.mesh),
                           room.solution);
  constexpr double end = std::numeric_limits<double>::infinity();
  for (double x = -0.19; x < 0.2; x += 0.02) {
    for (const double away : {0.01, 1.0, 300.0}) {
      const Eigen::Vector3d to = middle + Eigen::Vector3d(x, 0.03, 0);
      const Eigen::Vector3d down(0.1 * away, 0, -away);
      const auto below = lamps.first({.origin = to + down, .direction = -down.normalized()}, end);
      ASSERT_TRUE(below);
      EXPECT_FALSE(below->is_body);
      const auto expected = static_cast<float>(8.0 / (-0.16 * down.normalized().z()));
      EXPECT_NEAR(below->radiance[0], expected, rounding * expected);
      // Rays meet in floats: eight roundings of the way and of coordinates up to 4 m.
      EXPECT_NEAR(below->t, down.norm(), double{2 * rounding} * (down.norm() + 4.0));
      const Eigen::Vector3d up(0, 0, 0.2 + away);
      const auto above = lamps.first({.origin = to + up, .direction = -up.normalized()}, end);
      ASSERT_TRUE(above);
      EXPECT_TRUE(above->is_body);
      EXPECT_EQ(above->normal.z(), 1.0);
    }
  }
}

/// A luminaire that shines to both sides has an opening at either end of its body.
TEST(VisibleLamps, BothEndsOfABodyShine) {
  Scene scene = furnace(8.0f);
  scene.lamps[0].shape = IntensityShape{};
  const SolvedScene room = solved(scene);
  const VisibleLamps lamps(scene, ElementCaster(room.mesh), DirectLight(scene, room.mesh),
                           room.solution);
  for (const double side : {-1.0, 1.0}) {
    const Eigen::Vector3d way(0, 0, -side);
    const auto seen = lamps.first({.origin = middle - way, .direction = way}, 10.0);
    ASSERT_TRUE(seen);
    EXPECT_FALSE(seen->is_body);
    EXPECT_NEAR(seen->t, 0.9, double{rounding} * 2.0);  // coordinates up to 2 m
    EXPECT_NEAR(seen->radiance[0], 50.0f, rounding * 50.0f) << "I / A";
  }
}

/// L = M / pi + rho L / 4. A lobe of roughness 0.05 spreads by 3 degrees, so the body fills it; its
/// surface loses less than 0.5 % by shadowing (Heitz 2014). The light is known, so there is no
/// noise.
TEST(VisibleLamps, RoughMirrorsShowBodies) {
  Scene scene = furnace(0.0f, 0.05f);
  scene.lamps[0].body = {.along_c0 = 3.0, .along_c90 = 3.0, .height = 0.2};
  scene.lamps[0].opening = {};
  const Image image = picture(scene, solved(scene), looking({2, 2, 1.4}, {2, 2, 0}));
  const float expected = inv_pi + 0.5f * inv_pi;
  constexpr float shadowed = 5e-3f;
  EXPECT_NEAR(image.radiance.mean(), expected, (shadowed + converged) * expected);
}

/// The highlight of a panel above a luminaire in a rough floor of a black room: the body adds its
/// own light and takes none of the panel's, by directions of the lobe as by those to the panel.
TEST(VisibleLamps, BodiesDoNotHideHighlights) {
  Scene scene = furnace(0.0f, 0.3f);
  scene.materials[0] = test::diffuse(scene.bands, 0.0f);
  scene.materials[1].emission.setZero();
  const int shining = test::add_material(scene, test::diffuse(scene.bands, 0.0f, 10.0f));
  test::add_polygon(scene, "panel", shining,
                    {{1.7, 1.7, 2.9}, {1.7, 2.3, 2.9}, {2.3, 2.3, 2.9}, {2.3, 1.7, 2.9}});
  const SolvedScene room = solved(scene);
  Camera eye = looking({1, 2, 1.2}, {2, 2, 0});
  eye.fov_degrees = 60.0;
  eye.width = eye.height = 8;
  Scene bare = scene;
  bare.lamps.clear();
  const RenderOptions options{.sampling = {.most = 64, .least = 64}};
  const Image with = picture(scene, room, eye, options),
              without = picture(bare, room, eye, options);
  constexpr float of_sums = 64 * std::numeric_limits<float>::epsilon();  // 64 samples of a pixel
  EXPECT_TRUE((with.radiance >= (1.0f - of_sums) * without.radiance).all());
  EXPECT_GT(without.radiance.mean(), 0.0f) << "the floor shows highlights alone";
}

/// A picture that shows no luminaire has the same bits with bodies and without, in every pass.
TEST(VisibleLamps, BodiesBlockNoLight) {
  Scene scene = furnace(8.0f);
  scene.materials[1].specular.setZero();
  const SolvedScene room = solved(scene);
  Camera eye{.position = {2, 2, 1.4}, .direction = -Eigen::Vector3d::UnitZ()};
  eye.up = Eigen::Vector3d::UnitX();
  eye.fov_degrees = 60.0;
  eye.width = eye.height = 12;
  Scene bare = scene;
  bare.lamps[0].body = {};
  for (const Pass pass : {Pass::interpolate, Pass::direct, Pass::gather}) {
    const RenderOptions options{.pass = pass, .gather_rays = 16};
    const Image with = picture(scene, room, eye, options);
    EXPECT_TRUE((with.radiance == picture(bare, room, eye, options).radiance).all());
  }
}

TEST(VisibleLamps, LayersShowBodies) {
  const Scene scene = furnace();
  const SolvedScene room = solved(scene);
  const RenderOptions options{.pass = Pass::interpolate,
                              .layers = {Layer::albedo, Layer::normal, Layer::depth,
                                         Layer::indirect, Layer::emission, Layer::patch}};
  const Image image = picture(scene, room, looking({0.7, 2, 1.6}, {1.7, 2, 1.6}), options);
  const auto value = [&](const std::string& name) {
    const auto& names = image.layers.names;
    const auto at = std::find(names.begin(), names.end(), name) - names.begin();
    return image.layers.values(0, at);
  };
  EXPECT_NEAR(value("albedo.G"), 0.5f, rounding);
  EXPECT_NEAR(value("normal.X"), -1.0f, rounding);
  EXPECT_NEAR(value("depth.Z"), 1.0f, 2 * rounding);
  EXPECT_EQ(value("emission.G"), 0.0f);
  EXPECT_NEAR(value("indirect.G"), image.radiance(0, 1), rounding);
  EXPECT_EQ(value("patch.id"), -1.0f);
}

}  // namespace
}  // namespace lightwell::visible_lamps_test
