#include "raytrace/display/light_meter.h"

#include <gtest/gtest.h>

#include <numbers>
#include <optional>
#include <utility>
#include <vector>

#include "mesh/build_patches.h"
#include "raytrace/display/display.h"
#include "scene/scene.h"

namespace lightwell::light_meter_test {
namespace {

// A wall of 4 x 4 m at z = 0 that a camera at z = 3 looks at, and a pane before it if `has_pane`.
Scene wall_scene(bool has_pane) {
  Scene scene;
  Material wall;
  wall.reflectance = constant_spectrum(scene.bands, 0.3f);
  Material pane;
  pane.reflectance = constant_spectrum(scene.bands, 0.0f);
  pane.dielectric = Dielectric{.tint = constant_spectrum(scene.bands, 1.0f), .thin = true};
  scene.materials = {wall, pane};
  const auto square = [&](double z, int material) {
    PolygonMesh mesh{.vertices = {{-2, -2, z}, {2, -2, z}, {2, 2, z}, {-2, 2, z}},
                     .facets = {Facet{}}};
    mesh.facets[0].boundary = {0, 1, 2, 3};
    scene.surfaces.push_back({.name = "square", .material = material, .shape = std::move(mesh)});
  };
  square(0.0, 0);
  if (has_pane) square(1.0, 1);
  Camera camera;
  camera.position = {0, 0, 3};
  camera.direction = -Eigen::Vector3d::UnitZ();
  camera.width = 30;
  camera.height = 20;
  scene.cameras = {camera};
  return scene;
}

struct Metered {
  Scene scene{};
  PatchMesh mesh{};
  BandArray irradiance{};
  std::vector<char> clear{};
};

// The wall gets `E` everywhere.
Metered metered(bool has_pane, const Eigen::Array3f& E) {
  Metered m{.scene = wall_scene(has_pane)};
  m.mesh = build_patches(m.scene, {});
  m.irradiance = BandArray::Zero(m.mesh.vertex_count(), 3);
  for (int e = 0; e < m.mesh.element_count(); ++e) {
    const bool is_wall = m.mesh.material[m.mesh.patch[e]] == 0;
    m.clear.push_back(is_wall ? 0 : 1);
    for (int c = 0; is_wall && c < m.mesh.corner_count(e); ++c) {
      m.irradiance.row(m.mesh.corners[e][c]) = E.transpose();
    }
  }
  return m;
}

std::optional<IncidentLight> light_of(const Metered& m) {
  const ElementCaster caster(m.mesh);
  return meter_incident_light(caster, m.irradiance, m.clear, m.scene.bands,
                              m.scene.cameras.front());
}

// Whatever the wall's reflectance: x = pi L / E. Irradiance, weights of corners and colours are
// floats, each rounded by 6e-8; ten roundings stay below 1e-6.
TEST(LightMeter, WhitePaperUnderTheMeanLightIsOne) {
  for (const bool has_pane : {false, true}) {
    const auto light = light_of(metered(has_pane, {500, 500, 500}));
    ASSERT_TRUE(light);
    EXPECT_NEAR(light->exposure * 500 / std::numbers::pi, 1.0, 1e-6);
    EXPECT_NEAR(luminance(light->colour), 1.0, 1e-6);
  }
}

TEST(LightMeter, DarkPlacesGiveNoExposure) {
  EXPECT_FALSE(light_of(metered(false, {0, 0, 0})));
}

// Gains of white balance turn the colour of the light to grey of the same luminance.
TEST(LightMeter, WhiteBalanceMakesPaperGrey) {
  const auto light = light_of(metered(false, {700, 400, 150}));
  ASSERT_TRUE(light);
  const Eigen::Array3f paper = light->colour * white_balance(light->colour);
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(paper[c], 1.0, 1e-6);
}

// A black body of 6504 K lies beside daylight of 6504 K, the white of Rec. 709, on the chromaticity
// diagram: x = 0.3135, y = 0.3236 against 0.3127, 0.3290, which is up to 4.4 % of a channel; the
// fitted colour-matching functions add up to 1.6 %. At 2700 K blue is a fifth of the luminance (x =
// 0.4599, y = 0.4106: R 1.935, G 0.804, B 0.192); the fit is off by up to 2 % of the whole.
TEST(LightMeter, BlackBodiesHaveTheirColours) {
  const Eigen::Array3f daylight = colour_of_black_body(6504), warm = colour_of_black_body(2700);
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(daylight[c], 1.0, 0.06);
  EXPECT_NEAR(warm[0], 1.935, 0.04);
  EXPECT_NEAR(warm[1], 0.804, 0.02);
  EXPECT_NEAR(warm[2], 0.192, 0.02);
}

}  // namespace
}  // namespace lightwell::light_meter_test
