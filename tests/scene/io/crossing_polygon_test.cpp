#include "scene/io/crossing_polygon.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

#include "scene/sampling.h"

namespace lightwell::crossing_polygon_test {
namespace {

using Eigen::Vector3d;

std::vector<Loop> cut(const Polygon& polygon) {
  std::vector<Vector3d> corners = polygon.boundary;
  for (const Loop& hole : polygon.holes) corners.insert(corners.end(), hole.begin(), hole.end());
  std::vector<Loop> pieces;
  for (const auto& piece : convex_pieces(polygon)) {
    Loop& loop = pieces.emplace_back();
    for (const PieceCorner& corner : piece) loop.push_back(corner.of(corners));
  }
  return pieces;
}

// Area along z, positive where the loop is counter-clockwise.
double area(const Loop& loop) {
  double twice = 0.0;
  for (std::size_t i = 0; i < loop.size(); ++i) {
    twice += loop[i].cross(loop[(i + 1) % loop.size()]).z();
  }
  return 0.5 * twice;
}

double area(const std::vector<Loop>& loops) {
  double sum = 0.0;
  for (const Loop& loop : loops) sum += area(loop);
  return sum;
}

int winding(const Loop& loop, const Vector3d& q) {
  double turn = 0.0;
  for (std::size_t i = 0; i < loop.size(); ++i) {
    const Vector3d a = loop[i] - q, b = loop[(i + 1) % loop.size()] - q;
    turn += std::atan2(a.x() * b.y() - a.y() * b.x(), a.x() * b.x() + a.y() * b.y());
  }
  return static_cast<int>(std::lround(turn / (2.0 * std::numbers::pi)));
}

double distance(const Loop& loop, const Vector3d& q) {
  double least = 1e300;
  for (std::size_t i = 0; i < loop.size(); ++i) {
    const Vector3d a = loop[i], d = loop[(i + 1) % loop.size()] - a;
    const double t = std::clamp(d.dot(q - a) / std::max(d.squaredNorm(), 1e-300), 0.0, 1.0);
    least = std::min(least, (q - a - t * d).norm());
  }
  return least;
}

TEST(ConvexPieces, CoverBothWingsOfABowTie) {
  // Two triangles of area 1 whose signed areas cancel; the sharpest corner, the second, turns
  // right.
  EXPECT_NEAR(-area(cut({{{0, 0, 0}, {2, 2, 0}, {2, 0, 0}, {0, 2, 0}}})), 2.0, 1e-12);
}

// The pentagram of radius 1 winds twice round its pentagon. Its outline is ten triangles between
// the centre, a tip at radius 1 and a corner of the pentagon at radius cos 72 / cos 36.
TEST(ConvexPieces, FillTheMiddleOfAPentagram) {
  constexpr double degree = std::numbers::pi / 180.0;
  Loop star;
  for (int i = 0; i < 5; ++i) {
    star.emplace_back(std::cos(144.0 * degree * i), std::sin(144.0 * degree * i), 0);
  }
  const double inner = std::cos(72.0 * degree) / std::cos(36.0 * degree);
  EXPECT_NEAR(area(cut({star})), 10.0 * 0.5 * inner * std::sin(36.0 * degree), 1e-12);
}

TEST(ConvexPieces, HaveNoPartOfSpikesAndFoldedEdges) {
  const std::vector<Loop> spiked{
      {{0, 0, 0}, {1, 0, 0}, {3, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}},
      {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}},
      {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0.5, 0.5, 0}, {1, 1, 0}, {0, 1, 0}}};
  for (const Loop& loop : spiked) EXPECT_NEAR(area(cut({loop})), 1.0, 1e-12);
  EXPECT_TRUE(cut({{{0, 0, 0}, {1, 0, 0}, {3, 0, 0}, {2, 0, 0}}}).empty());
  EXPECT_TRUE(cut({{{1, 2, 3}, {1, 2, 3}, {1, 2, 3}}}).empty());
  EXPECT_TRUE(cut({Loop{}}).empty());
}

TEST(ConvexPieces, LeaveOutHolesWhereverTheseLie) {
  const auto square = [](double low, double high) {
    return Loop{{low, low, 0}, {high, low, 0}, {high, high, 0}, {low, high, 0}};
  };
  EXPECT_NEAR(area(cut({square(0, 4), {square(1, 2)}})), 16.0 - 1.0, 1e-12);
  EXPECT_NEAR(area(cut({square(0, 4), {square(3, 5)}})), 16.0 - 1.0, 1e-12);
  EXPECT_NEAR(area(cut({square(0, 4), {square(6, 7)}})), 16.0, 1e-12);
  EXPECT_NEAR(area(cut({square(0, 4), {square(1, 3), square(2, 3)}})), 16.0 - 4.0, 1e-12);
}

// Every point that the boundary winds round lies in one piece, every other point in none. Points
// nearer to an edge than what rounding moves the edge, some 1e-9 of the size, are not asked.
TEST(ConvexPieces, CoverWhatTheBoundaryWindsRoundOnce) {
  for (std::uint64_t seed = 0; seed < 150; ++seed) {
    auto number = [&, count = std::uint64_t{0}](bool on_lattice) mutable {
      const double u = random_uniform(random_key(seed, ++count));
      return on_lattice ? std::floor(6.0 * u) / 6.0 : u;
    };
    const bool on_lattice = seed % 3 == 0;  // corners repeat, touch edges and lie on lines
    Loop loop;
    for (std::uint64_t i = 0; i < 4 + seed % 9; ++i) {
      const double x = number(on_lattice);
      loop.emplace_back(x, number(on_lattice), 0.0);
    }
    const std::vector<Loop> pieces = cut({loop});
    const double front = area(pieces) < 0.0 ? -1.0 : 1.0;
    for (const Loop& piece : pieces) EXPECT_GT(front * area(piece), 0.0) << seed;
    for (int i = 0; i < 200; ++i) {
      const double x = number(false);
      const Vector3d q(x, number(false), 0.0);
      if (distance(loop, q) < 1e-7) continue;
      int covered = 0;
      bool is_on_cut = false;
      for (const Loop& piece : pieces) {
        is_on_cut = is_on_cut || distance(piece, q) < 1e-7;
        covered += winding(piece, q) != 0 ? 1 : 0;
      }
      if (is_on_cut) continue;
      EXPECT_EQ(covered, winding(loop, q) != 0 ? 1 : 0) << seed;
    }
  }
}

TEST(ConvexPieces, KeepCornersAndInterpolateAlongEdges) {
  const Loop bow{{0, 0, 0}, {2, 2, 2}, {2, 0, 0}, {0, 2, 2}};
  int crossings = 0;
  for (const auto& piece : convex_pieces({bow})) {
    for (const PieceCorner& corner : piece) {
      if (corner.from == corner.to) continue;
      ++crossings;
      const std::vector<double> value{0.0, 1.0, 0.0, 1.0};  // half of z
      EXPECT_NEAR(2.0 * corner.of(value), corner.of(bow).z(), 1e-12);
    }
  }
  EXPECT_GT(crossings, 0);
}

}  // namespace
}  // namespace lightwell::crossing_polygon_test
