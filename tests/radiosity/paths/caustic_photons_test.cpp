#include "radiosity/paths/caustic_photons.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "mesh/build_patches.h"
#include "radiosity/gather/caustic_irradiance.h"
#include "radiosity/gather/final_gather.h"
#include "radiosity/paths/specular_targets.h"
#include "tests/radiosity/test_scenes.h"

namespace lightwell::caustic_photons_test {
namespace {

using Eigen::Vector3d;

// A cube of 2 m with black walls and what else is given.
Scene black_room() {
  Scene scene;
  const int black = test::add_material(scene, test::diffuse(scene.bands, 0.0f));
  test::add_box(scene, {-1, -1, -1}, {1, 1, 1}, {black, black, black, black, black, black}, true);
  return scene;
}

void add_lamp(Scene& scene, const Vector3d& center, double half, float M,
              const std::string& name = "lamp") {
  const int lamp = test::add_material(scene, test::diffuse(scene.bands, 0.0f, M));
  const Vector3d x(half, 0, 0), y(0, half, 0);
  test::add_polygon(scene, name, lamp,
                    {center - x - y, center - x + y, center + x + y, center + x - y});  // down
}

void add_sphere(Scene& scene, const Material& material, const Vector3d& center, double radius) {
  scene.surfaces.push_back({.name = "ball",
                            .material = test::add_material(scene, material),
                            .shape = Sphere{.center = center, .radius = radius}});
}

Material lossless_glass(const Bands& bands) {
  Material glass = test::clear_glass(bands);
  glass.dielectric->tint = constant_spectrum(bands, 1.0f);
  return glass;
}

struct Shot {
  PatchMesh mesh;
  ElementCaster caster;
  DirectLight light;
  explicit Shot(const Scene& scene)
      : mesh(build_patches(scene, {.max_patch_size = 0.5})), caster(mesh), light(scene, mesh) {}
};

// Form factor from a small lamp to a ball straight below it: (R / d)^2; clear glass loses nothing.
TEST(CausticPhotons, CarryWhatALampSendsToAGlassBall) {
  Scene scene = black_room();
  add_lamp(scene, {0, 0, 0.8}, 1e-3, 5.0f);
  add_sphere(scene, lossless_glass(scene.bands), {0, 0, -0.2}, 0.3);
  const Shot shot(scene);
  const auto photons = shoot_photons({scene, shot.caster, shot.light}, 1 << 14, 40);
  const double power = 5.0 * 4e-6 * 0.09;
  // All rays of the cone around the ball meet it, each for the cosine it has; 1e-5 of its size are
  // the margin, 1e-6 the lamp's own extent.
  EXPECT_NEAR(photons.power.col(0).cast<double>().sum() / power, 1.0, 1e-3);
}

// Two lamps and three balls, one of which hides another from a lamp: what every pair is aimed at
// adds up to what rays all around find, whichever is met first.
TEST(CausticPhotons, AddUpToWhatRaysAllAroundFind) {
  Scene scene = black_room();
  add_lamp(scene, {-0.3, 0, 0.9}, 0.1, 5.0f);
  add_lamp(scene, {0.6, 0.5, 0.7}, 0.05, 9.0f, "small lamp");
  add_sphere(scene, test::clear_glass(scene.bands), {-0.3, 0, 0.3}, 0.2);
  add_sphere(scene, test::tinted_mirror(scene.bands), {-0.2, 0.1, -0.4}, 0.4);
  add_sphere(scene, test::clear_glass(scene.bands), {0.6, 0.6, 0.55}, 0.1);
  const Shot shot(scene);
  constexpr int rays = 1 << 19;
  const BandArray E = caustic_irradiance({scene, shot.caster, shot.light}, rays, 16);
  // Elements of a cube are equal squares: their vertices' means add up to what they got. Photons
  // pass the balls, which have an irradiance, too.
  double all_around = 0.0;
  for (int e = 0; e < shot.mesh.element_count(); ++e) {
    const Surface& surface = scene.surfaces[shot.mesh.surface[shot.mesh.patch[e]]];
    if (scene.materials[surface.material].is_specular()) continue;
    double mean = 0.0;
    for (int c = 0; c < shot.mesh.corner_count(e); ++c) {
      mean += E.row(shot.mesh.corners[e][c]).cast<double>().sum() / shot.mesh.corner_count(e);
    }
    all_around += mean * shot.mesh.element_area[e];
  }
  const auto photons = shoot_photons({scene, shot.caster, shot.light}, 1 << 17, 16);
  // At least a tenth of the rays of either lamp meet a ball: sqrt(9 / 2^19) = 0.4 %; and about as
  // much for the photons.
  EXPECT_NEAR(photons.power.cast<double>().sum() / all_around, 1.0, 0.01);
}

// The lamp is within the bounds of what surrounds it, a bowl of mirrors: no cone holds those.
TEST(CausticPhotons, LeaveALampWithinASpecularSurface) {
  Scene scene = black_room();
  add_lamp(scene, {0, 0, 0.2}, 0.01, 5.0f);
  const Material mirror = test::tinted_mirror(scene.bands);
  const int of_mirror = test::add_material(scene, mirror);
  test::add_polygon(
      scene, "mirror", of_mirror,
      {{-0.99, -0.99, -0.5}, {0.99, -0.99, -0.5}, {0.99, 0.99, -0.5}, {-0.99, 0.99, -0.5}});
  const Shot shot(scene);
  const auto photons = shoot_photons({scene, shot.caster, shot.light}, 1 << 15, 4);
  // Point to a coaxial square of half width a at distance d, by its four quarters.
  const double a = 0.99, d = 0.7, s = std::hypot(a, d);
  const double F = 4.0 * (a / s) * std::atan(a / s) / M_PI;
  const double power = F * 5.0 * 4e-4 * static_cast<double>(mirror.specular[0]);
  // F (1 - F) / N for independent rays: 0.2 % of F.
  EXPECT_NEAR(photons.power.col(0).cast<double>().sum() / power, 1.0, 0.005);
}

TEST(CausticPhotons, NoneWithoutSpecularSurfaces) {
  Scene scene = black_room();
  add_lamp(scene, {0, 0, 0.8}, 0.1, 5.0f);
  const Shot shot(scene);
  EXPECT_EQ(shoot_photons({scene, shot.caster, shot.light}, 1024, 8).count(), 0u);
  EXPECT_THROW(shoot_photons({scene, shot.caster, shot.light}, 0, 8), std::invalid_argument);
}

TEST(SpecularTargets, ManyAreAFewHeapsThatHoldThem) {
  Scene scene = black_room();
  const Material glass = test::clear_glass(scene.bands);
  for (int i = 0; i < 200; ++i) {
    add_sphere(scene, glass, {-0.9 + 0.009 * i, 0.5 * std::sin(i), 0.1 * (i % 7)}, 0.001);
  }
  const SpecularTargets targets(scene);
  EXPECT_LE(targets.count(), SpecularTargets::most);
  EXPECT_GE(targets.count(), SpecularTargets::most / 4);  // none are all of the view
  const auto facets = scene_facets(scene);
  for (std::size_t f = 0; f < facets.size(); ++f) {
    const int target = targets.of_facet(static_cast<int>(f));
    const auto* ball = std::get_if<Sphere>(&scene.surfaces[facets[f].surface].shape);
    ASSERT_EQ(target >= 0, ball != nullptr);
    if (!ball) continue;
    EXPECT_LT((ball->center - targets.target(target).center).norm() + ball->radius,
              targets.target(target).radius);
    EXPECT_LT(targets.target(target).radius, 0.6);
  }
}

TEST(SpecularTargets, TheFacesOfABlockAreOneAndBallsApartAreTwo) {
  Scene scene = black_room();
  const int mirror = test::add_material(scene, test::tinted_mirror(scene.bands));
  test::add_box(scene, {0, 0, 0}, {0.2, 0.2, 0.4}, {mirror, mirror, mirror, mirror, mirror, mirror},
                false);
  EXPECT_EQ(SpecularTargets(scene).count(), 1);
  Scene balls = black_room();
  add_sphere(balls, test::clear_glass(balls.bands), {-0.5, 0, 0}, 0.2);
  add_sphere(balls, test::clear_glass(balls.bands), {0.5, 0, 0}, 0.2);
  EXPECT_EQ(SpecularTargets(balls).count(), 2);
}

}  // namespace
}  // namespace lightwell::caustic_photons_test
