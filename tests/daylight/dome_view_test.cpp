#include "daylight/dome_view.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

#include "mesh/build_patches.h"
#include "radiosity/closed_forms/polygon_form_factor.h"
#include "tests/radiosity/test_scenes.h"

namespace lightwell::dome_view_test {
namespace {

using Eigen::Vector3d;
using std::numbers::pi;

// A scene with what rays of receivers need.
class Rays {
 public:
  explicit Rays(Scene scene)
      : scene_(std::move(scene)),
        mesh_(build_patches(scene_, {.max_patch_size = 1.0})),
        caster_(mesh_),
        panes_(scene_),
        paths_(scene_, caster_, 8, PathDetail::points) {}

  Surroundings around() const {
    return {caster_, panes_, paths_.has_specular() ? &paths_ : nullptr, scene_.bands.count()};
  }
  DomeView view(const Vector3d& position, const Vector3d& normal, std::uint64_t key = 1) const {
    const SurfacePoint point{.position = position, .normal = normal};
    return view_of_dome(around(), sky, {&point, 1}, {}, key);
  }
  // The sun's irradiance at a point that faces up.
  float sun(const Vector3d& position, const Vector3d& towards, int rays = 16) const {
    const SurfacePoint point{.position = position, .normal = Vector3d::UnitZ()};
    const SunDisc disc(sky, towards.normalized());
    return sunlight(around(), {&point, 1}, view(position, Vector3d::UnitZ()), {&disc, 1}, rays, 1)(
        0, 0);
  }

  const SkyPatches sky{2, Vector3d::UnitZ(), Vector3d::UnitY()};

 private:
  Scene scene_;
  PatchMesh mesh_;
  ElementCaster caster_;
  ClearPanes panes_;
  LightPaths paths_;
};

void add_rectangle(Scene& scene, int material, const Vector3d& low, const Vector3d& high) {
  test::add_polygon(scene, "rectangle", material,
                    {low, {high.x(), low.y(), low.z()}, high, {low.x(), high.y(), high.z()}});
}

// A black roof of 20 m x 20 m, 2 m high, with a hole of 2 m x 1 m; `cover` closes it.
constexpr double roof = 2.0, half_x = 1.0, half_y = 0.5;
Scene roof_with_hole(const std::vector<Material>& cover = {}) {
  Scene scene;
  const int black = test::add_material(scene, test::diffuse(scene.bands, 0.0f));
  constexpr double far = 10.0;
  add_rectangle(scene, black, {-far, -far, roof}, {-half_x, far, roof});
  add_rectangle(scene, black, {half_x, -far, roof}, {far, far, roof});
  add_rectangle(scene, black, {-half_x, -far, roof}, {half_x, -half_y, roof});
  add_rectangle(scene, black, {-half_x, half_y, roof}, {half_x, far, roof});
  for (const Material& material : cover) {
    add_rectangle(scene, test::add_material(scene, material), {-half_x, -half_y, roof},
                  {half_x, half_y, roof});
  }
  return scene;
}

// Light through the hole at a point below, over that of the whole dome.
double hole_form_factor(const Vector3d& at) {
  const std::vector<Vector3d> hole = {{-half_x, -half_y, roof},
                                      {-half_x, half_y, roof},
                                      {half_x, half_y, roof},
                                      {half_x, -half_y, roof}};
  return std::abs(point_to_polygon(at, Vector3d::UnitZ(), hole));
}

// Light that comes past the edges of a roof that ends `far` from its middle, of a point below.
double past_a_roof(const Vector3d& at, double far) {
  const std::vector<Vector3d> all = {
      {-far, -far, roof}, {-far, far, roof}, {far, far, roof}, {far, -far, roof}};
  return 1.0 - std::abs(point_to_polygon(at, Vector3d::UnitZ(), all));
}
double past_the_roof(const Vector3d& at) {
  return past_a_roof(at, 10.0);
}

}  // namespace

// Rays count for the share of each cell that arrives, so that nothing is left to chance where all
// of them do. The sum of 577 floats rounds to 1e-6.
TEST(DomeView, OfAnOpenFieldIsExact) {
  Scene scene;
  const int black = test::add_material(scene, test::diffuse(scene.bands, 0.0f));
  add_rectangle(scene, black, {-1.0, -1.0, -1.0}, {1.0, 1.0, -1.0});
  const Rays rays(scene);
  const DomeView view = rays.view(Vector3d::Zero(), Vector3d::UnitZ());
  const Eigen::ArrayXd U = rays.sky.irradiances(Vector3d::UnitZ());
  for (int c = 0; c < rays.sky.dome_count(); ++c) {
    ASSERT_NEAR(double{view.coefficient(c, 0)}, U[c], 1e-6 * U[c]);
  }
  EXPECT_NEAR(double{view.coefficient.col(0).sum()}, pi, 1e-6 * pi);
}

// The sun that falls through the hole lights 8 of 16 points in a row. Rays of 4 points, other ones
// for each receiver, find 0 or all of its light, in the mean half; four errors of the mean of 1024.
// Cosines within the disc differ from 1 by 1e-5.
TEST(DomeView, SunOfSomePointsIsInTheMeanThatOfAll) {
  const Rays rays(roof_with_hole());
  std::vector<SurfacePoint> points;
  for (int i = 0; i < 16; ++i) {
    points.push_back({.position = {0.25 + 0.1 * i, 0.0, 0.0}, .normal = Vector3d::UnitZ()});
  }
  const SunDisc sun(rays.sky, Vector3d::UnitZ());
  const DomeView view = view_of_dome(rays.around(), rays.sky, points, {}, 1);
  ASSERT_NE(view.open[static_cast<std::size_t>(sun.cell)], 0);
  const auto light = [&](int count, std::uint64_t key) {
    return double{sunlight(rays.around(), points, view, {&sun, 1}, count, key)(0, 0)};
  };
  EXPECT_NEAR(light(16, 1), 0.5, 1e-5);
  EXPECT_NEAR(light(64, 1), 0.5, 1e-5);
  constexpr int keys = 1024;
  double sum = 0.0;
  for (int k = 0; k < keys; ++k) sum += light(4, static_cast<std::uint64_t>(k));
  EXPECT_NEAR(sum / keys, 0.5, 4.0 * 0.5 / std::sqrt(keys));
}

// A search of one cell in four misses a hole of half a cell's size in most views. The ray that then
// stands for four closed cells finds the hole in as many views as makes up for that. Five standard
// errors of the mean of the views.
TEST(DomeView, OneCellInFourHasNoBias) {
  Scene scene;
  const int black = test::add_material(scene, test::diffuse(scene.bands, 0.0f));
  constexpr double far = 30.0, low = 0.5, high = 0.58;
  add_rectangle(scene, black, {-far, -far, roof}, {low, far, roof});
  add_rectangle(scene, black, {high, -far, roof}, {far, far, roof});
  add_rectangle(scene, black, {low, -far, roof}, {high, low, roof});
  add_rectangle(scene, black, {low, high, roof}, {high, far, roof});
  const Rays rays(scene);
  const SkyPatches fine(4, Vector3d::UnitZ(), Vector3d::UnitY());
  const SurfacePoint point{.position = Vector3d::Zero(), .normal = Vector3d::UnitZ()};
  const std::vector<Vector3d> hole = {
      {low, low, roof}, {low, high, roof}, {high, high, roof}, {high, low, roof}};
  const double expected = pi * (std::abs(point_to_polygon(point.position, point.normal, hole)) +
                                past_a_roof(point.position, far));
  constexpr int views = 4096;
  double sum = 0.0, squares = 0.0;
  for (int i = 0; i < views; ++i) {
    const DomeView view =
        view_of_dome(rays.around(), fine, {&point, 1}, {.search = 1, .rays = 64, .stride = 4},
                     static_cast<std::uint64_t>(i));
    const auto light = double{view.coefficient.col(0).sum()};
    sum += light;
    squares += light * light;
  }
  const double mean = sum / views, error = std::sqrt((squares / views - mean * mean) / views);
  EXPECT_NEAR(mean, expected, 5.0 * error);
  // The hole is a tenth of the light, so that its loss is seen, or its fourfold weight.
  EXPECT_LT(error, 0.01 * expected);
}

// Rays within cells are stratified; an edge of the hole, 6 m long in all, cuts some 40 cells with
// some 40 rays each, whose noise is below half of a cell's light over 40^(3/4), independent from
// cell to cell: 0.5 / 16 / sqrt(40) = 0.5 % of the light. Four of these.
TEST(DomeView, ThroughAHoleIsItsFormFactor) {
  const Rays rays(roof_with_hole());
  for (const Vector3d& at : {Vector3d(0.0, 0.0, 0.0), Vector3d(1.5, 0.3, 0.5)}) {
    const double expected = pi * (hole_form_factor(at) + past_the_roof(at));
    const double found = double{rays.view(at, Vector3d::UnitZ()).coefficient.col(1).sum()};
    EXPECT_NEAR(found, expected, 0.02 * expected);
  }
}

// A search that misses the hole leaves its light to single rays through the cells: noise, but no
// bias. The mean of 64 views of a small hole far up is compared with the closed form by its own
// standard error.
TEST(DomeView, IsRightInTheMeanWhereTheSearchFindsNothing) {
  const Rays rays(roof_with_hole());
  const Vector3d low(3.0, 2.0, -28.0);
  constexpr int views = 64;
  double sum = 0.0, squares = 0.0;
  for (int k = 0; k < views; ++k) {
    const SurfacePoint point{.position = low, .normal = Vector3d::UnitZ()};
    const DomeView view = view_of_dome(rays.around(), rays.sky, {&point, 1},
                                       {.search = 1, .rays = 64}, static_cast<std::uint64_t>(k));
    const auto found = double{view.coefficient.col(0).sum()};
    sum += found;
    squares += found * found;
  }
  const double mean = sum / views, error = std::sqrt((squares / views - mean * mean) / views);
  EXPECT_NEAR(mean, pi * (hole_form_factor(low) + past_the_roof(low)), 4.0 * error);
}

TEST(DomeView, PanesAndSolidGlassPassTheirShare) {
  const Vector3d at(0.0, 0.0, 0.0);
  const double open = double{Rays(roof_with_hole()).view(at, Vector3d::UnitZ()).coefficient.sum()};
  Scene scene;
  Material pane = test::diffuse(scene.bands, 0.0f);
  pane.one_sided = false;
  pane.dielectric = Dielectric{
      .index_of_refraction = 1.0f, .tint = constant_spectrum(scene.bands, 0.5f), .thin = true};
  const double tinted =
      double{Rays(roof_with_hole({pane})).view(at, Vector3d::UnitZ()).coefficient.sum()};
  // The same rays, half of whose light passes by the hole's 1 - past_the_roof.
  const double through = 3.0 * pi * hole_form_factor(at);
  EXPECT_NEAR(tinted, open - 0.5 * through, 0.02 * open);
  // A slab as a body with two faces, clear and without reflections, moves no light.
  Material glass = pane;
  glass.dielectric =
      Dielectric{.index_of_refraction = 1.0f, .tint = constant_spectrum(scene.bands, 1.0f)};
  Scene slab = roof_with_hole();
  const int material = test::add_material(slab, glass);
  test::add_box(slab, {-half_x, -half_y, roof - 0.01}, {half_x, half_y, roof + 0.01},
                {material, material, material, material, material, material}, false);
  const double solid = double{Rays(slab).view(at, Vector3d::UnitZ()).coefficient.sum()};
  EXPECT_NEAR(solid, open, 0.02 * open);
}

TEST(Sunlight, ComesThroughTheHoleAsADisc) {
  const Rays rays(roof_with_hole());
  const Vector3d at(0.3, 0.1, 0.0);
  // Cosines differ over the disc, 0.0047 in radius, by its half times the sine, 0.0995; four
  // standard errors of 16 rays.
  EXPECT_NEAR(double{rays.sun(at, {0.1, 0.0, 1.0})}, 1.0 / std::sqrt(1.01),
              4.0 * 0.5 * 0.0047 * 0.0995 / 4.0);
  EXPECT_EQ(rays.sun(at, {3.0, 0.0, 1.0}), 0.0f);
  // The middle of the sun on the hole's straight edge: half of the disc, to four standard errors of
  // 4096 rays, 4 sqrt(1/4/4096).
  const Vector3d edge(half_x - at.x(), 0.0, roof);
  EXPECT_NEAR(double{rays.sun(at, edge, 4096)} / edge.normalized().z(), 0.5, 0.032);
}

}  // namespace lightwell::dome_view_test
