#include "radiosity/closed_forms/polygon_exchange.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

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
