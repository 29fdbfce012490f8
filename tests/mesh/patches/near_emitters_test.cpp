#include "mesh/patches/near_emitters.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "mesh/build_patches.h"
#include "mesh/patches/round_grid.h"
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

// A ball of 10 cm above ground of 80 m, in sunlight askew to its axis: E = max(cos, 0). Linear
// elements of d = pi / 8 are off by twice d^2 / 8 where the cosine is smooth. Along the bound of
// sunlight, where its slope drops by 1 at most, they are off by d / 4 in either direction, on cells
// within sqrt(2) d of the bound: sin(sqrt(2) d) of the area.
TEST(FineEnough, SmallBallsFollowSunlight) {
  Scene scene = empty_scene();
  scene.surfaces.push_back(
      {.name = "ground",
       .material = 0,
       .shape = PolygonMesh{.vertices = {{-40, -40, 0}, {40, -40, 0}, {40, 40, 0}, {-40, 40, 0}},
                            .facets = {Facet{.boundary = {0, 1, 2, 3}}}}});
  const Sphere ball{.center = {0, 0, 1}, .radius = 0.1};
  add_sphere(scene, "ball", ball);
  const PatchMesh mesh = build_patches(scene, {.to_be_refined = true});
  ASSERT_EQ(mesh.round_grids.size(), 1u);
  const RoundGrid& grid = mesh.round_grids.front();
  const Eigen::Vector3d sun = Eigen::Vector3d(2, 1, 2) / 3.0;
  const auto E = [&](const Eigen::Vector3d& p) {
    return std::max(sun.dot(p - ball.center) / ball.radius, 0.0);
  };
  constexpr int steps = 128;  // even in area: z, and the longitude
  double square = 0.0;
  for (int i = 0; i < steps * steps; ++i) {
    const double z = -1.0 + 2.0 * (i % steps + 0.5) / steps;
    const double phi = 2.0 * std::numbers::pi * (i / steps + 0.5) / steps, r = std::sqrt(1 - z * z);
    const Eigen::Vector3d p =
        ball.center + ball.radius * Eigen::Vector3d(r * std::cos(phi), r * std::sin(phi), z);
    const RoundGridPoint place = round_grid_point(grid, p);
    const int e = grid.element[static_cast<std::size_t>(place.ring) * grid.sectors + place.sector];
    const Eigen::Array4f w = round_weights(grid, place);
    double interpolated = 0.0;
    for (int c = 0; c < mesh.corner_count(e); ++c) {
      interpolated += double{w[c]} * E(mesh.position(mesh.corners[e][c]));
    }
    square += std::pow(interpolated - E(p), 2) / (steps * steps);
  }
  const double d = std::numbers::pi / 8.0;
  const double smooth = 2.0 * d * d / 8.0, bound = 2.0 * d / 4.0;
  EXPECT_LT(square, smooth * smooth + std::sin(std::numbers::sqrt2 * d) * bound * bound);
}

// 2 n^2 elements of each of 8192 balls are to be no more than 65536: n = 2 rings.
TEST(FineEnough, ManyBallsHaveFewElements) {
  const CutSize of_many = fine_enough(Sphere{.radius = 0.01}, size, 8192);
  EXPECT_LE(of_many.pieces(std::numbers::pi * 0.01), 2);
  EXPECT_EQ(fine_enough(Sphere{.radius = 0.01}, size, 1).pieces(std::numbers::pi * 0.01), 8);
  EXPECT_EQ(fine_enough(Sphere{.radius = 9.0}, size, 1).elements_per_edge, size.elements_per_edge);
}

// A patch is up to 10^13 meridians long here, more than integers count.
TEST(FineEnough, TheSmallestBallsHaveAsManyElementsAsOthers) {
  for (const double r : {1e-2, 1e-5, 1e-10, 1e-14}) {
    const Sphere ball{.center = {1, 2, 3}, .radius = r};
    const CutSize fine = fine_enough(ball, size, 1);
    EXPECT_EQ(fine.pieces(std::numbers::pi * r), 8) << r;
    const RoundElements elements = round_elements(ball, fine);
    EXPECT_EQ(elements.rings, 8) << r;
    EXPECT_EQ(elements.sectors, 16) << r;
    // The fewest patches of a ball: two rows of four, and the end of the last.
    EXPECT_EQ(elements.first_element.size(), 9u) << r;
  }
}

}  // namespace
}  // namespace lightwell::near_emitters_test
