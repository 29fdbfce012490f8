#include "radiosity/visibility/point_form_factor.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "mesh/build_patches.h"
#include "scene/parallel.h"
#include "tests/radiosity/polygons.h"

namespace lightwell::point_form_factor_test {
namespace {

using Eigen::Vector3d;
using test::Corners;
using test::Polygons;

constexpr double pi = std::numbers::pi;
// Rounding of a few atan2, and of corners moved to the mesh's centre and back.
constexpr double rounding = 1e-12;

// Element below the corner of a parallel a x b rectangle at distance h (Howell's catalogue, B-3).
double corner_above(double a, double b, double h) {
  const double x = a / h, y = b / h, rx = std::sqrt(1 + x * x), ry = std::sqrt(1 + y * y);
  return (x / rx * std::atan(y / rx) + y / ry * std::atan(x / ry)) / (2 * pi);
}

// Lamp 0 x0..x1, y0..y1 at height h over the origin, facing down.
Corners lamp(double x0, double x1, double y0, double y1, double h) {
  return {{x0, y0, h}, {x0, y1, h}, {x1, y1, h}, {x1, y0, h}};
}

struct Rig {
  explicit Rig(const std::vector<Corners>& polygons)
      : scene(polygons), caster(scene.mesh), F(caster) {}
  double closed_form(const ReceivingPoint& point, int shooter = 0,
                     const PointFormFactorOptions& options = {}) const {
    double value = -1.0;
    F.by_closed_form(shooter, {&point, 1}, {&value, 1}, options);
    return value;
  }
  double discs(const ReceivingPoint& point, int n, int shooter = 0) const {
    double value = -1.0;
    F.by_discs(shooter, n, {&point, 1}, {&value, 1});
    return value;
  }
  Polygons scene;
  ElementCaster caster;
  PointFormFactors F;
};

TEST(PointFormFactor, UnoccludedIsTheClosedForm) {
  const Rig above({lamp(0, 0.7, 0, 1.3, 0.9)});
  EXPECT_NEAR(above.closed_form({}), corner_above(0.7, 1.3, 0.9), rounding);

  // A wall a high and b wide that begins at distance c from the element, at its corner (Howell's
  // catalogue, B-4).
  const double a = 1.2, b = 0.8, c = 0.5;
  const Rig beside({{{0, c, 0}, {b, c, 0}, {b, c, a}, {0, c, a}}});
  const double x = a / b, y = c / b, r = std::sqrt(x * x + y * y);
  EXPECT_NEAR(beside.closed_form({}), (std::atan(1 / y) - y / r * std::atan(1 / r)) / (2 * pi),
              rounding);
}

TEST(PointFormFactor, ByDiscsConvergesWithTheirNumber) {
  const Rig rig({lamp(-0.5, 0.5, -0.5, 0.5, 0.6)});
  const double exact = 4 * corner_above(0.5, 0.5, 0.6);
  // Relative bias of discs: -A / (n pi r^2) at most, r >= h. The noise of samples falls faster.
  double before = 1.0;
  for (const int n : {4, 16, 64, 256, 1024, 4096}) {
    constexpr int points = 32;
    double mean = 0.0;
    for (std::uint64_t key = 0; key < points; ++key) {
      mean += rig.discs({.key = key}, n) / points;
    }
    const double bias = 1.0 / (n * pi * 0.36);
    EXPECT_LT(mean, exact) << n;
    EXPECT_NEAR(mean, exact, bias * exact) << n;
    EXPECT_LT(std::abs(mean - exact), 0.35 * before) << n;  // a quarter, with room for noise
    before = std::abs(mean - exact);
  }
}

TEST(PointFormFactor, BehindTheEdgeOfAPlaneIsExact) {
  // A half plane at half height, seen from the origin, hides the lamp beyond x = 0.2: twice 0.1.
  const Corners half_plane = {{0.1, -9, 0.4}, {9, -9, 0.4}, {9, 9, 0.4}, {0.1, 9, 0.4}};
  const Rig rig({lamp(-0.5, 0.5, -0.5, 0.5, 0.8), half_plane});
  const double exact = 2 * (corner_above(0.5, 0.5, 0.8) + corner_above(0.2, 0.5, 0.8));
  EXPECT_NEAR(rig.closed_form({}), exact, 1e-10);
  // The disc form finds the same edge by rays: error of n points along a line about n^-3/4.
  constexpr int n = 4096;
  EXPECT_NEAR(rig.discs({}, n), exact, 4.0 * std::pow(n, -0.75));
  // Exactly half.
  const Corners in_the_middle = {{0, -9, 0.4}, {9, -9, 0.4}, {9, 9, 0.4}, {0, 9, 0.4}};
  const Rig half({lamp(-0.5, 0.5, -0.5, 0.5, 0.8), in_the_middle});
  EXPECT_NEAR(half.closed_form({}), 2 * corner_above(0.5, 0.5, 0.8), 1e-10);
}

TEST(PointFormFactor, BehindASphereIsSampledToTheTarget) {
  Scene scene;
  const int grey = test::add_material(scene, test::diffuse(scene.bands, 0.5f));
  test::add_polygon(scene, "lamp", grey, lamp(-0.5, 0.5, -0.5, 0.5, 1.0));
  scene.surfaces.push_back({.name = "ball",
                            .material = grey,
                            .shape = Sphere{.center = {0.3, 0.0, 0.5}, .radius = 0.2}});
  const PatchMesh mesh = build_patches(scene, {.max_patch_size = 1e3});
  const ElementCaster caster(mesh);
  const PointFormFactors F(caster);
  // Many points at one position, whose mean is more accurate than any of them.
  constexpr int count = 400;
  constexpr double target = 2e-3;
  std::vector<ReceivingPoint> points(count);
  for (int i = 0; i < count; ++i) points[i].key = static_cast<std::uint64_t>(i);
  std::vector<double> values(count), fine(count);
  F.by_closed_form(0, points, values, {.max_rays = 4096, .target_error = target});
  F.by_closed_form(0, points, fine, {.min_rays = 4096, .max_rays = 4096});
  double mean = 0.0, square = 0.0;
  for (int i = 0; i < count; ++i) {
    mean += fine[i] / count;
    EXPECT_TRUE(fine[i] > 0.0 && fine[i] < 4 * corner_above(0.5, 0.5, 1.0));
  }
  for (int i = 0; i < count; ++i) square += (values[i] - mean) * (values[i] - mean) / count;
  EXPECT_LT(std::sqrt(square), target);
  // Patches of the ball shoot as discs.
  int ball = 0;
  while (mesh.surface[ball] == 0) ++ball;
  const ReceivingPoint below{.position = {0.3, 0.0, 0.0}};
  double value = -1.0;
  for (; ball < mesh.patch_count(); ++ball) {
    F.by_closed_form(ball, {&below, 1}, {&value, 1});
    EXPECT_TRUE(value >= 0.0 && value <= 1.0);
  }
}

// A wall from floor to ceiling divides a room; points at its foot see nothing of the other side.
TEST(PointFormFactor, DoesNotLeakUnderAWallThatTouches) {
  Scene scene;
  const int grey = test::add_material(scene, test::diffuse(scene.bands, 0.5f));
  test::add_box(scene, {0, 0, 0}, {2, 1, 1}, {grey, grey, grey, grey, grey, grey}, true);
  Material both = scene.materials[grey];
  both.one_sided = false;
  test::add_polygon(scene, "wall", test::add_material(scene, both),
                    {{0.9, 0, 0}, {0.9, 0, 1}, {0.9, 1, 1}, {0.9, 1, 0}});
  const PatchMesh mesh = build_patches(scene, {.max_patch_size = 0.5});
  const ElementCaster caster(mesh);
  const PointFormFactors F(caster);
  std::vector<ReceivingPoint> left, right;
  for (int e = 0; e < mesh.element_count(); ++e) {
    const bool is_left = element_center(mesh, e).position.x() < 0.9;
    if (mesh.surface[mesh.patch[e]] == 6) continue;
    for (int k = 0; k < mesh.corner_count(e); ++k) {
      (is_left ? left : right).push_back(receiving_corner(mesh, e, k));
    }
  }
  ASSERT_FALSE(left.empty() || right.empty());
  int touching = 0;
  for (int shooter = 0; shooter < mesh.patch_count(); ++shooter) {
    const double x = element_center(mesh, mesh.first_element[shooter]).position.x();
    if (mesh.surface[shooter] == 6) continue;
    const auto& hidden = x < 0.9 ? right : left;
    std::vector<double> values(hidden.size()), discs(hidden.size());
    F.by_closed_form(shooter, hidden, values);
    F.by_discs(shooter, 16, hidden, discs);
    for (std::size_t i = 0; i < hidden.size(); ++i) {
      touching += std::abs(hidden[i].position.x() - 0.9) < 1e-3;
      EXPECT_EQ(values[i], 0.0);
      // In single precision a ray that grazes the floor may pass under the wall, of negligible
      // weight.
      EXPECT_LT(discs[i], 1e-6);
    }
  }
  EXPECT_GT(touching, 0);
  // A point sees all of its own half, wall included: closure to rounding, shooters in the point's
  // own plane contributing 0.
  double worst = 0.0;
  std::vector<double> sum(left.size(), 0.0), values(left.size());
  for (int shooter = 0; shooter < mesh.patch_count(); ++shooter) {
    F.by_closed_form(shooter, left, values);
    for (std::size_t i = 0; i < left.size(); ++i) sum[i] += values[i];
  }
  for (const double s : sum) worst = std::max(worst, std::abs(s - 1.0));
  EXPECT_LT(worst, 1e-9);
}

TEST(PointFormFactor, OnTheShootersPlaneIsNothingAndAtItsEdgeFinite) {
  const Corners floor = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  const Corners wall = {{0, 0, 0}, {0, 1, 0}, {0, 1, 1}, {0, 0, 1}};
  const Rig rig({wall, floor});
  const Vector3d up = Vector3d::UnitZ();
  for (const Vector3d& at : {Vector3d(0, 0.5, 0), Vector3d(0, 0, 0), Vector3d(0, 0.5, 1),
                             Vector3d(0, 2, 0), Vector3d(-0.5, 0.5, 0)}) {
    EXPECT_EQ(rig.closed_form({.position = at, .normal = up}), 0.0) << at.transpose();
    EXPECT_EQ(rig.discs({.position = at, .normal = up}, 64), 0.0) << at.transpose();
  }
  // At the foot of a wall F is 1/2, at any distance other than 0.
  for (const double away : {1e-2, 1e-4, 1e-6}) {
    const ReceivingPoint point{.position = {away, 0.5, 0}, .normal = up};
    EXPECT_NEAR(rig.closed_form(point), 0.5, 2.0 * away);
    const double discs = rig.discs(point, 64);
    EXPECT_TRUE(discs >= 0.0 && discs <= 1.0);
  }
}

TEST(PointFormFactor, DependsOnNothingButShooterAndPoint) {
  const Corners screen = {{-0.2, -0.1, 0.4}, {0.3, -0.2, 0.4}, {0.1, 0.3, 0.5}};
  Scene scene;
  const int grey = test::add_material(scene, test::diffuse(scene.bands, 0.5f));
  test::add_polygon(scene, "lamp", grey, lamp(-0.5, 0.5, -0.5, 0.5, 1.0));
  test::add_polygon(scene, "screen", grey, screen);
  scene.surfaces.push_back(
      {.name = "ball", .material = grey, .shape = Sphere{.center = {0.3, 0, 0.6}, .radius = 0.2}});
  const PatchMesh mesh = build_patches(scene, {.max_patch_size = 1e3});
  const ElementCaster caster(mesh);
  const PointFormFactors F(caster);
  std::vector<ReceivingPoint> points;
  for (std::uint64_t i = 0; i < 1000; ++i) {
    points.push_back({.position = {0.002 * static_cast<double>(i) - 1.0, 0.1, 0}, .key = i});
  }
  std::vector<double> all(points.size()), turned(points.size()), one(points.size());
  F.by_closed_form(0, points, all);
  std::reverse(points.begin(), points.end());
  {
    const ThreadLimit limit(1);
    F.by_closed_form(0, points, turned);
  }
  for (std::size_t i = 0; i < points.size(); ++i) {
    F.by_closed_form(0, {&points[i], 1}, {&one[i], 1});
    EXPECT_EQ(one[i], turned[i]);
    EXPECT_EQ(one[i], all[points.size() - 1 - i]);
  }
}

}  // namespace
}  // namespace lightwell::point_form_factor_test
