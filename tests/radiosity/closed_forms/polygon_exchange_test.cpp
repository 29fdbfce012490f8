#include "radiosity/closed_forms/polygon_exchange.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

#include "scene/sampling.h"
#include "tests/radiosity/view_factor_cases.h"

namespace lightwell::polygon_exchange_test {
namespace {

using Eigen::Vector3d;
using Loop = std::vector<Vector3d>;

double area(const Loop& loop) {
  Vector3d sum = Vector3d::Zero();
  for (std::size_t i = 2; i < loop.size(); ++i) {
    sum += (loop[i - 1] - loop[0]).cross(loop[i] - loop[0]);
  }
  return 0.5 * sum.norm();
}

Loop moved(Loop loop, const Eigen::Matrix3d& turn, double scale, const Vector3d& shift) {
  for (Vector3d& v : loop) v = scale * (turn * v) + shift;
  return loop;
}

double form_factor(const Loop& first, const Loop& second) {
  return polygon_exchange(polygon_outline({first}), polygon_outline({second})) / area(first);
}

TEST(PolygonExchange, AgreesWithTheCatalogue) {
  int count = 0;
  for (const auto& c : test::view_factor_cases()) {
    if (!c.blockers.empty()) continue;
    const double F = form_factor(c.first, c.second);
    // Error that the quadrature aims at.
    EXPECT_NEAR(F, c.F12, 1e-9) << c.name;
    ++count;
  }
  EXPECT_GE(count, 18);
}

TEST(PolygonExchange, IsTheSameFromBothEndsInEveryPlaceAndSize) {
  const Eigen::Matrix3d turn =
      Eigen::AngleAxisd(1.1, Vector3d(0.3, -1.0, 2.0).normalized()).toRotationMatrix();
  for (const auto& c : test::view_factor_cases()) {
    const double F = form_factor(c.first, c.second);
    EXPECT_NEAR(form_factor(c.second, c.first) * area(c.second), F * area(c.first), 1e-12)
        << c.name;
    for (const double scale : {1e-3, 1.0, 1e3}) {
      const Vector3d shift = scale * Vector3d(10.0, -20.0, 5.0);
      const double there =
          form_factor(moved(c.first, turn, scale, shift), moved(c.second, turn, scale, shift));
      EXPECT_NEAR(there, F, 1e-8) << c.name << " at scale " << scale;
    }
  }
}

// Parallel squares L x L at distance 1; Howell's catalogue, C-11.
double parallel_squares(double L) {
  const double hypotenuse = std::sqrt(1.0 + L * L);
  return 2.0 / (std::numbers::pi * L * L) *
         (std::log(hypotenuse * hypotenuse / std::sqrt(1.0 + 2.0 * L * L)) +
          2.0 * L * hypotenuse * std::atan(L / hypotenuse) - 2.0 * L * std::atan(L));
}

// Rounding: terms of size 1 in units of the pair, and the conditioning of the formula above.
constexpr double in_closed_form = 1e-11;

TEST(PolygonExchange, OfPlatesHoweverNear) {
  const Eigen::Matrix3d turn =
      Eigen::AngleAxisd(0.7, Vector3d(1.0, 2.0, 3.0).normalized()).toRotationMatrix();
  for (const double L : {1.0, 50.0, 500.0, 1000.0, 1e4, 1e5}) {
    const Loop floor = moved({{0, 0, 0}, {L, 0, 0}, {L, L, 0}, {0, L, 0}}, turn, 1.0, {0, 0, 0});
    const Loop ceiling = moved({{0, 0, 1}, {0, L, 1}, {L, L, 1}, {L, 0, 1}}, turn, 1.0, {0, 0, 0});
    const double F = parallel_squares(L);
    EXPECT_NEAR(form_factor(floor, ceiling), F, in_closed_form) << "L = " << L;
    // Halves along either diagonal; of one pair of diagonals, the edges cross at the gap.
    double sum = 0.0;
    for (const Loop& half : {Loop{floor[0], floor[1], floor[2]}, {floor[0], floor[2], floor[3]}}) {
      for (const Loop& other :
           {Loop{ceiling[0], ceiling[1], ceiling[3]}, {ceiling[1], ceiling[2], ceiling[3]}}) {
        sum += form_factor(half, other) / 2.0;
      }
    }
    EXPECT_NEAR(sum, F, 1e-9) << "L = " << L << ": the error that the quadrature aims at";
  }
}

// Unit squares with a common edge. F by the contour integral in 30 digits (mpmath), and to 1e-10 by
// integrating Lambert's formula over one of the squares.
TEST(PolygonExchange, OfWedgesHoweverNarrow) {
  struct Wedge {
    double degrees, F;
  };
  for (const auto& [degrees, F] :
       {Wedge{90.0, 0.200043776075}, Wedge{10.0, 0.849606124963}, Wedge{2.0, 0.966633501486},
        Wedge{1.0, 0.982997178575}, Wedge{0.5, 0.991402547449}, Wedge{0.1, 0.998261391654},
        Wedge{0.01, 0.999825556593}}) {
    const double angle = degrees * std::numbers::pi / 180.0;
    const double x = std::cos(angle), z = std::sin(angle);
    const double found = form_factor({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}},
                                     {{0, 0, 0}, {0, 1, 0}, {x, 1, z}, {x, 0, z}});
    EXPECT_NEAR(found, F, in_closed_form) << degrees << " degrees";
  }
}

// A triangle and a quadrilateral above it, turned, tilted and of any size, as a whole and in four
// parts that meet in a point: edges cross at gaps down to 1e-5.
TEST(PolygonExchange, PartsAddUpHoweverNearTheirEdgesCross) {
  for (std::uint64_t k = 0; k < 1000; ++k) {
    const auto uniform = [&](std::uint64_t n) { return random_uniform(random_key(k, n)); };
    const double gap = std::pow(10.0, -5.0 * uniform(0)), size = std::pow(10.0, -2.0 * uniform(1));
    const double tilt = k % 5 == 0 ? 0.0 : 0.5 * std::pow(10.0, -6.0 * uniform(2));
    const Loop triangle = {{0, 0, 0}, {1, 0, 0}, {uniform(3), 0.3 + uniform(4), 0}};
    const double turn = 2.0 * std::numbers::pi * uniform(5);
    const auto above = [&](double a, double b) {
      const double x = size * (a * std::cos(turn) - b * std::sin(turn));
      const double y = size * (a * std::sin(turn) + b * std::cos(turn));
      return Vector3d(uniform(6) - 0.3 + x, uniform(7) - 0.3 + y, gap + tilt * (size + x));
    };
    const Loop quad = {above(-0.4, -0.4), above(-0.3, 0.6), above(0.5, 0.5), above(0.6, -0.3)};
    const Vector3d inside = above(0.1 * uniform(8), 0.1 * uniform(9));
    const PatchOutline from = polygon_outline({triangle});
    double sum = 0.0;
    for (std::size_t c = 0; c < 4; ++c) {
      sum += polygon_exchange(from, polygon_outline({{quad[c], quad[(c + 1) % 4], inside}}));
    }
    const double whole = polygon_exchange(from, polygon_outline({quad}));
    // The error that the quadrature aims at, for a whole and four parts.
    EXPECT_NEAR(sum, whole, 5e-9 * std::min(area(triangle), area(quad)))
        << "gap " << gap << ", tilt " << tilt << ", size " << size;
  }
}

TEST(PolygonExchange, PartsAddUp) {
  // A square as a whole, and as a frame around a hole plus the square that fills the hole.
  const Loop floor = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  const Loop wall = {{0, 0, 0}, {0, 1, 0}, {0, 1, 1}, {0, 0, 1}};
  const Loop hole = {{0, 0.2, 0.3}, {0, 0.7, 0.3}, {0, 0.7, 0.6}, {0, 0.2, 0.6}};
  const PatchOutline seen_from = polygon_outline({floor});
  const double whole = polygon_exchange(seen_from, polygon_outline({wall}));
  const double frame =
      polygon_exchange(seen_from, polygon_outline({wall, {hole.rbegin(), hole.rend()}}));
  const double rest = polygon_exchange(seen_from, polygon_outline({hole}));
  EXPECT_NEAR(frame + rest, whole, 1e-10);
  EXPECT_GT(rest, 0.0);
}

TEST(PolygonExchange, OnlyWhatLiesBeforeThePlaneCounts) {
  // A wall that sinks below the floor: the part beneath cannot be seen.
  const Loop floor = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  const Loop above = {{-0.5, 0, 0}, {-0.5, 1, 0}, {-0.5, 1, 1}, {-0.5, 0, 1}};
  const Loop sunk = {{-0.5, 0, -1}, {-0.5, 1, -1}, {-0.5, 1, 1}, {-0.5, 0, 1}};
  const PatchOutline seen_from = polygon_outline({floor});
  EXPECT_NEAR(polygon_exchange(seen_from, polygon_outline({sunk})),
              polygon_exchange(seen_from, polygon_outline({above})), 1e-12);
  const Loop turned_away = {above.rbegin(), above.rend()};
  EXPECT_EQ(polygon_exchange(seen_from, polygon_outline({turned_away})), 0.0);
  const Loop coplanar = {{2, 0, 0}, {3, 0, 0}, {3, 1, 0}, {2, 1, 0}};
  EXPECT_EQ(polygon_exchange(seen_from, polygon_outline({coplanar})), 0.0);
}

TEST(PolygonExchange, BoxesCloseWhateverTheirShape) {
  for (std::uint64_t k = 0; k < 20; ++k) {
    // Sides from 0.03 to 30: needles to slabs.
    const auto side = [&](std::uint64_t axis) {
      return std::pow(10.0, 3.0 * random_uniform(random_key(k, axis)) - 1.5);
    };
    const double x = side(0), y = side(1), z = side(2);
    const Loop floor = {{0, 0, 0}, {x, 0, 0}, {x, y, 0}, {0, y, 0}};
    const std::vector<Loop> others = {{{0, 0, z}, {0, y, z}, {x, y, z}, {x, 0, z}},
                                      {{0, 0, 0}, {0, y, 0}, {0, y, z}, {0, 0, z}},
                                      {{x, 0, 0}, {x, 0, z}, {x, y, z}, {x, y, 0}},
                                      {{0, 0, 0}, {0, 0, z}, {x, 0, z}, {x, 0, 0}},
                                      {{0, y, 0}, {x, y, 0}, {x, y, z}, {0, y, z}}};
    double sum = 0.0;
    for (const Loop& other : others) sum += form_factor(floor, other);
    EXPECT_NEAR(sum, 1.0, 1e-8) << x << " x " << y << " x " << z;
  }
}

}  // namespace
}  // namespace lightwell::polygon_exchange_test
