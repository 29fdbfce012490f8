#include "mesh/patches/near_emitters.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/mesh/mesh_scenes.h"

namespace lightwell::near_emitters_test {
namespace {

using namespace lightwell::test;

constexpr double radius = 0.1;
const Frustum shade{.base = {0, 0, 0}, .height = 0.3, .base_radius = radius, .top_radius = radius};
const CutSize size{.patch_size = 0.4, .elements_per_edge = 2};

// A shade about a bulb of radius r on its axis, or a square of the same half width.
Scene scene_with(double r, bool is_square, const Eigen::Vector3d& center) {
  Scene scene = empty_scene();
  scene.materials.push_back({.name = "bulb", .emission = constant_spectrum(scene.bands, 1.0f)});
  const int bulb = static_cast<int>(scene.materials.size()) - 1;
  scene.surfaces.push_back({.name = "shade", .material = 0, .shape = shade});
  if (is_square) {
    PolygonMesh mesh{
        .vertices = {center + Eigen::Vector3d(-r, -r, 0), center + Eigen::Vector3d(r, -r, 0),
                     center + Eigen::Vector3d(r, r, 0), center + Eigen::Vector3d(-r, r, 0)},
        .facets = {Facet{.boundary = {0, 1, 2, 3}}}};
    scene.surfaces.push_back({.name = "bulb", .material = bulb, .shape = mesh});
  } else {
    scene.surfaces.push_back(
        {.name = "bulb", .material = bulb, .shape = Sphere{.center = center, .radius = r}});
  }
  return scene;
}

// A bulb of 2 cm lies 8 cm from a shade of 10 cm, and elements of 20 cm become shorter than 2 cm: a
// tenth. The box of the ball is nearer by up to its corner, 2 cm (sqrt 2 - 1); elements are a whole
// part of those of 20 cm, up to a tenth shorter, and a tenth more is left for it.
TEST(NearEmitters, ElementsOfAShadeAreAQuarterOfTheWayToItsBulb) {
  for (const bool is_square : {false, true}) {
    const Scene scene = scene_with(0.02, is_square, {0, 0, 0.15});
    const CutSize cut = NearEmitters(scene).cut(shade, 0, size);
    EXPECT_EQ(cut.patch_size, size.patch_size);
    EXPECT_LE(cut.element_size(), 0.25 * 0.08);
    EXPECT_GE(cut.element_size(), 0.25 * (0.08 - 0.02 * (std::numbers::sqrt2 - 1.0)) / 1.2);
  }
}

TEST(NearEmitters, LeaveShapesFarFromThemAlone) {
  // 0.8 m are four elements.
  const Scene scene = scene_with(0.02, false, {0, 0, 0.3 + 0.8 + 0.03});
  EXPECT_EQ(NearEmitters(scene).cut(shade, 0, size).elements_per_edge, size.elements_per_edge);
}

TEST(NearEmitters, AreLampsToo) {
  Scene scene = empty_scene();
  scene.surfaces.push_back({.name = "shade", .material = 0, .shape = shade});
  scene.lamps.push_back({.name = "lamp", .position = {0, 0, 0.2}});
  EXPECT_EQ(NearEmitters(scene).cut(shade, 0, size).element_size(), 0.25 * radius);
}

TEST(NearEmitters, AtTheShapeMakeElementsATwelfthOfItAtLeast) {
  const Scene scene = scene_with(0.02, false, {radius, 0, 0.15});
  const NearEmitters near(scene);
  // A ball around the shade reaches from its middle to the rims. Elements are a whole part of those
  // of 20 cm, here 13 of 15.4 mm or more; one of 15 mm would be a 14th.
  const double ball = std::hypot(radius, 0.15);
  const double length = near.cut(shade, 0, size).element_size();
  EXPECT_LE(length, ball / 12.0);
  EXPECT_GE(length, ball / 12.0 * 13.0 / 14.0);
  // A column of 3 m stays as it is.
  const Frustum column{
      .base = {0, 0, 0}, .height = 3.0, .base_radius = radius, .top_radius = radius};
  EXPECT_LE(near.cut(column, 0, size).elements_per_edge, 2 * size.elements_per_edge);
  // An emitter is not near itself.
  EXPECT_EQ(
      near.cut(Sphere{.center = {radius, 0, 0.15}, .radius = 0.02}, 1, size).elements_per_edge,
      size.elements_per_edge);
}

}  // namespace
}  // namespace lightwell::near_emitters_test
