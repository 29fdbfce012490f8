#include "radiosity/visibility/visible_exchange.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

#include "radiosity/closed_forms/polygon_exchange.h"
#include "scene/sampling.h"
#include "tests/radiosity/polygons.h"

namespace lightwell::visible_exchange_test {
namespace {

using Eigen::Vector3d;
using test::Corners;
using test::Polygons;

constexpr double tolerance = 1e-7;  // m^2; the patches have about 1 m^2

// S of polygons 0 and 1 of the scene, integrated over polygon `over`.
VisibleExchange exchange(const std::vector<Corners>& polygons, int over = 0,
                         double asked = tolerance) {
  const Polygons p(polygons);
  const Shafts shafts(p.mesh);
  const ShaftEnd from = p.end(shafts, over), to = p.end(shafts, 1 - over);
  const double unoccluded = polygon_exchange(patch_outline(p.mesh, 0), patch_outline(p.mesh, 1));
  Between between;
  shafts.find(from, to, between);
  if (between.is_nothing()) return {unoccluded, 0.0};
  const auto found = visible_exchange(shafts, from, to, between.pieces, unoccluded, asked);
  EXPECT_TRUE(found.has_value());
  return found.value_or(VisibleExchange{});
}

Corners rectangle(double x0, double x1, double y0, double y1, double z) {
  return {{x0, y0, z}, {x1, y0, z}, {x1, y1, z}, {x0, y1, z}};
}
Corners turned(const Corners& c) {
  return {c.rbegin(), c.rend()};
}

const Corners below = rectangle(0, 1, 0, 1, 0), above = turned(rectangle(0, 1, 0, 1, 1));

std::vector<Corners> box(const Vector3d& low, const Vector3d& high) {
  Scene scene;
  test::add_box(scene, low, high, {}, false);
  std::vector<Corners> faces;
  for (const Surface& s : scene.surfaces) {
    faces.push_back(std::get<PolygonMesh>(s.shape).vertices);
  }
  return faces;
}

// The worked example of docs/view-factors.md. Its value was found by clipping, to 13 digits.
TEST(VisibleExchange, OfPlatesWithABoxBetweenThemIsTheKnownValue) {
  std::vector<Corners> scene = {below, above};
  for (const Corners& face : box({0.3, 0.35, 0.2}, {0.6, 0.75, 0.6})) scene.push_back(face);
  const VisibleExchange S = exchange(scene);
  EXPECT_NEAR(S.value, 0.123862784, tolerance + 1e-9);
  EXPECT_LE(S.error, tolerance);
}

// Exchange past a screen, and through the hole of the screen's shape in a wall, adds up to the
// unoccluded exchange.
TEST(VisibleExchange, PastAScreenAndThroughItsHoleAddsUp) {
  const double all = exchange({below, above}).value;
  const Corners tilted = {{0.2, 0.3, 0.4}, {0.7, 0.2, 0.4}, {0.8, 0.6, 0.4}, {0.5, 0.9, 0.4}};
  const double big = 10.0;
  std::vector<Corners> through = {below, above};
  for (std::size_t k = 0; k < tilted.size(); ++k) {
    // The wall around the screen in four pieces, each from one edge outwards.
    const Vector3d middle(0.5, 0.5, 0.4);
    const Vector3d &a = tilted[k], &b = tilted[(k + 1) % tilted.size()];
    through.push_back({a, middle + big * (a - middle), middle + big * (b - middle), b});
  }
  const double past = exchange({below, above, tilted}).value;
  const double hole = exchange(through).value;
  EXPECT_GT(past, 0.1 * all);
  EXPECT_GT(hole, 0.1 * all);
  EXPECT_NEAR(past + hole, all, 2.0 * tolerance);
}

TEST(VisibleExchange, IsTheSameFromBothEnds) {
  const auto number = [](std::uint64_t a, std::uint64_t b) {
    return random_uniform(random_key(a, b, 9));
  };
  for (std::uint64_t k = 0; k < 20; ++k) {
    std::vector<Corners> scene = {below, above};
    for (std::uint64_t t = 0; t < 1 + k % 3; ++t) {
      Corners triangle;
      for (std::uint64_t c = 0; c < 3; ++c) {
        triangle.emplace_back(number(k, 9 * t + 3 * c), number(k, 9 * t + 3 * c + 1),
                              0.1 + 0.8 * number(k, 9 * t + 3 * c + 2));
      }
      scene.push_back(triangle);
    }
    const VisibleExchange a = exchange(scene, 0, 1e-6), b = exchange(scene, 1, 1e-6);
    // Each of the two values is off by about its own estimated error.
    EXPECT_NEAR(a.value, b.value, 2.0 * (a.error + b.error)) << "scene " << k;
    EXPECT_GE(a.value, 0.0);
    EXPECT_LE(a.value, exchange({below, above}).value);
  }
}

TEST(VisibleExchange, TakesWhatTwoScreensBothHideOnce) {
  const double one = exchange({below, above, rectangle(0.2, 0.8, 0.3, 0.7, 0.5)}).value;
  // Two screens in one plane that overlap by a strip; then two equal screens 1e-6 apart.
  const double cut = exchange({below, above, rectangle(0.2, 0.55, 0.3, 0.7, 0.5),
                               rectangle(0.45, 0.8, 0.3, 0.7, 0.5)})
                         .value;
  const double hair = 1e-6;
  const double twice = exchange({below, above, rectangle(0.2, 0.8, 0.3, 0.7, 0.5),
                                 rectangle(0.2, 0.8, 0.3, 0.7, 0.5 + hair)})
                           .value;
  EXPECT_NEAR(cut, one, 2.0 * tolerance);
  EXPECT_NEAR(twice, one, 2.0 * tolerance + hair);
}

TEST(VisibleExchange, IsNothingBehindWhatHidesAll) {
  // Exactly 0: behind one screen of the patches' own size, and behind the sides of a box together.
  EXPECT_EQ(exchange({below, above, rectangle(0, 1, 0, 1, 0.5)}).value, 0.0);
  std::vector<Corners> scene = {below, above};
  for (const Corners& face : box({-0.5, -0.5, 0.3}, {1.5, 1.5, 0.6})) scene.push_back(face);
  EXPECT_EQ(exchange(scene).value, 0.0);
}

// Exact in 2-D: very long strips that see each other over a screen have F = (sum of crossed strings
// - sum of uncrossed strings) / 2 a (Hottel 1954).
TEST(VisibleExchange, OfLongStripsIsHottelsCrossedStrings) {
  constexpr double length = 2e4;
  const Corners high = turned(rectangle(0, 1, 0, length, 1));
  const Corners screen = {{0.5, 0, 0}, {0.5, 0, 0.6}, {0.5, length, 0.6}, {0.5, length, 0}};
  // The screen stands at x = 0.5 and divides the floor; `left` is the left half.
  const Corners left = rectangle(0, 0.5, 0, length, 0);
  const VisibleExchange S = exchange({left, high, screen}, 0, 1e-5 * length);
  // Strings from the half strip (0,0)-(0.5,0) to (0,1)-(1,1) past the screen's top (0.5, 0.6):
  // crossed (0,0)-(top)-(1,1) and (0.5,0)-(0,1); uncrossed (0,0)-(0,1) and (0.5,0)-(top)-(1,1).
  const double to_top = std::hypot(0.5, 0.6), from_top = std::hypot(0.5, 0.4);
  const double crossed = to_top + from_top + std::hypot(0.5, 1.0);
  const double uncrossed = 1.0 + 0.6 + from_top;
  // The ends of the strips reduce F by a share of about width / length.
  EXPECT_NEAR(S.value / length, 0.5 * (crossed - uncrossed), 1e-5 + 2.0 / length);
}

// Occluders that touch a patch, share its edge or hang from it: 0 <= S <= unoccluded S, and S is
// the same integrated over either patch.
TEST(VisibleExchange, StaysInBoundsUnderTouchingOccluders) {
  const Corners wall = {{0, 0, 0}, {0, 1, 0}, {0, 1, 1}, {0, 0, 1}};
  const double tiny = 1e-9;
  const std::vector<Corners> occluders = {
      {{0.3, 0, 0}, {0.3, 1, 0}, {0.3, 1, 0.5}, {0.3, 0, 0.5}},  // on the floor
      {{0, 0, 0.5}, {0, 1, 0.5}, {0.5, 1, 0.5}, {0.5, 0, 0.5}},  // from the wall
      {{0, 0, 0}, {0, 1, 0}, {0.5, 1, 0.5}, {0.5, 0, 0.5}},      // in the common edge
      {{0, 0, 1}, {0, 1, 1}, {0.4, 1, 0.7}, {0.4, 0, 0.7}},      // at the wall's top
      {{1, 0, 0}, {1, 1, 0}, {0.6, 1, 0.4}, {0.6, 0, 0.4}},      // at the floor's edge
      {{0.2, 0.2, tiny}, {0.8, 0.2, tiny}, {0.8, 0.8, tiny}, {0.2, 0.8, tiny}},  // just above
      {{0.5, 0.5, 0}, {0.2, 0.2, 0.4}, {0.2, 0.8, 0.4}}};                        // by a corner
  const double all = exchange({below, wall}).value;
  for (std::size_t k = 0; k < occluders.size(); ++k) {
    const Polygons p({below, wall, occluders[k]});
    const Shafts shafts(p.mesh);
    for (int i = 0; i < p.mesh.patch_count(); ++i) {
      for (int j = i + 1; j < p.mesh.patch_count(); ++j) {
        const PatchOutline a = patch_outline(p.mesh, i), b = patch_outline(p.mesh, j);
        const double unoccluded = polygon_exchange(a, b);
        if (!(unoccluded > 0.0)) continue;
        const ShaftEnd from = p.end(shafts, i), to = p.end(shafts, j);
        Between between;
        shafts.find(from, to, between);
        const auto S = visible_exchange(shafts, from, to, between.pieces, unoccluded, 1e-5);
        const auto back = visible_exchange(shafts, to, from, between.pieces, unoccluded, 1e-5);
        ASSERT_TRUE(S && back);
        EXPECT_TRUE(S->value >= 0.0 && S->value <= unoccluded) << k;
        EXPECT_TRUE(S->error >= 0.0 && S->error < 1e-3 * all) << k << ": " << S->error;
        EXPECT_NEAR(S->value, back->value, 2.0 * (S->error + back->error)) << k;
      }
    }
  }
}

// The value at every tolerance lies within twice its estimated error of the best value.
TEST(VisibleExchange, KnowsItsError) {
  const Corners screen = {{0.2, 0.3, 0.4}, {0.7, 0.25, 0.55}, {0.6, 0.8, 0.5}};
  const double best = exchange({below, above, screen}, 0, 1e-9).value;
  double before = 1.0;
  for (const double asked : {1e-3, 1e-4, 1e-5, 1e-6, 1e-7}) {
    const VisibleExchange S = exchange({below, above, screen}, 0, asked);
    EXPECT_LE(S.error, asked);
    EXPECT_NEAR(S.value, best, 2.0 * S.error + 1e-9);
    EXPECT_LE(S.error, before);
    before = S.error;
  }
}

}  // namespace
}  // namespace lightwell::visible_exchange_test
