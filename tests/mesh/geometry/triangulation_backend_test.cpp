#include "mesh/geometry/triangulation_backend.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <set>

#include "mesh/geometry/cross.h"
#include "mesh/geometry/triangulate.h"
#include "scene/sampling.h"

namespace lightwell::triangulation_backend_test {
namespace {

using Eigen::Vector2d;
using Line = std::array<int, 2>;

struct Lines {
  std::vector<Vector2d> points{};
  std::vector<Line> lines{};
};

// Whole numbers from 0 to `most`. Up to 4096, products of four differences stay below 2^53, so
// that every sign and area of the checks below is exact in double precision.
double whole(std::uint64_t seed, std::uint64_t number, int most) {
  return std::floor(random_uniform(random_key(seed, number)) * (most + 1));
}

double turn(const Vector2d& a, const Vector2d& b, const Vector2d& c) {
  return cross(b - a, c - a);
}

// Positive if d lies in the circle through a, b, c (counter-clockwise); exact for whole numbers up
// to 4096: three terms, each of at most 2 * 4096^2 * 2 * 4096^2 = 2^50.
double in_circle(const Vector2d& a, const Vector2d& b, const Vector2d& c, const Vector2d& d) {
  const Vector2d u = a - d, v = b - d, w = c - d;
  return u.squaredNorm() * cross(v, w) + v.squaredNorm() * cross(w, u) +
         w.squaredNorm() * cross(u, v);
}

// Twice the area of the convex hull (Andrew 1979, "Another efficient algorithm for convex hulls in
// two dimensions").
double twice_hull_area(std::vector<Vector2d> points) {
  std::ranges::sort(points, [](const Vector2d& p, const Vector2d& q) {
    return std::pair(p.x(), p.y()) < std::pair(q.x(), q.y());
  });
  double area = 0.0;
  for (int side = 0; side < 2; ++side) {
    std::vector<Vector2d> chain;
    for (const Vector2d& p : points) {
      while (chain.size() > 1 && turn(chain[chain.size() - 2], chain.back(), p) <= 0.0) {
        chain.pop_back();
      }
      chain.push_back(p);
    }
    for (std::size_t i = 1; i < chain.size(); ++i) area += cross(chain[i - 1], chain[i]);
    std::ranges::reverse(points);
  }
  return area;
}

double twice_area(const PlanarTriangulation& t) {
  double area = 0.0;
  for (const auto& [a, b, c] : t.triangles) area += turn(t.points[a], t.points[b], t.points[c]);
  return area;
}

// Share of the line a-b that constrained edges within `rounding` of the line cover.
double covered(const PlanarTriangulation& t, const Vector2d& a, const Vector2d& b,
               double rounding) {
  const Vector2d along = b - a;
  const auto is_on = [&](const Vector2d& p) {
    const double at = along.dot(p - a), slack = rounding * along.norm();
    return std::abs(cross(along, p - a)) <= slack && at >= -slack &&
           at <= along.squaredNorm() + slack;
  };
  std::set<Line> edges;
  for (std::size_t i = 0; i < t.triangles.size(); ++i) {
    for (std::size_t c = 0; c < 3; ++c) {
      const int u = t.triangles[i][(c + 1) % 3], v = t.triangles[i][(c + 2) % 3];
      if (t.constrained[i][c]) edges.insert({std::min(u, v), std::max(u, v)});
    }
  }
  double length = 0.0;
  for (const auto& [u, v] : edges) {
    const Vector2d &p = t.points[u], &q = t.points[v];
    if (is_on(p) && is_on(q)) length += std::abs(along.dot(q - p));
  }
  return length / along.squaredNorm();
}

// Checks that neighbours name each other and that no edge but constraints has the point across the
// edge inside the circle of its triangle, or on it where the other diagonal ends in a lower number.
void expect_constrained_delaunay(const PlanarTriangulation& t) {
  for (std::size_t i = 0; i < t.triangles.size(); ++i) {
    const auto& [a, b, c] = t.triangles[i];
    const auto at = [&](int v) { return t.points[v]; };
    ASSERT_GT(turn(at(a), at(b), at(c)), 0.0);
    for (std::size_t k = 0; k < 3; ++k) {
      const int other = t.neighbor[i][k];
      if (other < 0) continue;
      const auto& back = t.neighbor[other];
      const auto opposite = std::find(back.begin(), back.end(), static_cast<int>(i));
      ASSERT_NE(opposite, back.end());
      const int d = t.triangles[other][opposite - back.begin()];
      if (t.constrained[i][k]) continue;
      const double side = in_circle(at(a), at(b), at(c), at(d));
      const int u = t.triangles[i][(k + 1) % 3], v = t.triangles[i][(k + 2) % 3];
      ASSERT_LE(side, 0.0);
      ASSERT_TRUE(side < 0.0 || std::min(u, v) < std::min(t.triangles[i][k], d));
    }
  }
}

// Points on a lattice, many of them cocircular, collinear or equal, and lines along its rows, which
// cross none but have points on them.
Lines lattice_rows(std::uint64_t seed) {
  Lines made;
  for (std::uint64_t i = 0; i < 150; ++i) {
    made.points.emplace_back(whole(seed, 2 * i, 15), whole(seed, 2 * i + 1, 15));
  }
  for (int i = 0; i < 150; ++i) {
    for (int j = i + 1; j < 150; ++j) {
      const Vector2d &p = made.points[i], &q = made.points[j];
      if (p.y() == q.y() && whole(seed, 1000 + 150 * i + j, 9) == 0) made.lines.push_back({i, j});
    }
  }
  return made;
}

// Points anywhere, and lines of different rows of them, which hold no circle empty but cross none.
Lines long_lines(std::uint64_t seed) {
  Lines made;
  for (std::uint64_t i = 0; i < 200; ++i) {
    made.points.emplace_back(whole(seed, 2 * i, 4096), whole(seed, 2 * i + 1, 4096));
  }
  for (int k = 0; k < 8; ++k) {
    const double y = 512.0 * k;
    made.lines.push_back(
        {static_cast<int>(made.points.size()), static_cast<int>(made.points.size()) + 1});
    made.points.emplace_back(0.0, y);
    made.points.emplace_back(4096.0, y + 500.0);
  }
  return made;
}

std::uint64_t bits_of(std::uint64_t hash, const PlanarTriangulation& t) {
  const auto add = [&](int value) {
    hash = (hash ^ static_cast<std::uint64_t>(value + 1)) * 0x100000001b3u;  // FNV-1a
  };
  for (std::size_t i = 0; i < t.triangles.size(); ++i) {
    for (std::size_t c = 0; c < 3; ++c) {
      add(t.triangles[i][c]);
      add(t.neighbor[i][c]);
      add(t.constrained[i][c] ? 1 : 0);
    }
  }
  return hash;
}

// The same number for every library: where no constraints cross, triangles have the same bits.
TEST(TriangulationBackend, GivesTheOneConstrainedDelaunayTriangulation) {
  std::uint64_t bits = 0xcbf29ce484222325u;
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    for (const Lines& made : {lattice_rows(seed), long_lines(seed)}) {
      SCOPED_TRACE(seed);
      const PlanarTriangulation t = triangulate(made.points, made.lines);
      ASSERT_EQ(t.points.size(), made.points.size()) << "no lines cross";
      expect_constrained_delaunay(t);
      ASSERT_EQ(twice_area(t), twice_hull_area(made.points));
      for (const auto& [a, b] : made.lines) {
        if (made.points[a] == made.points[b]) continue;
        ASSERT_EQ(covered(t, made.points[a], made.points[b], 0.0), 1.0);
      }
      bits = bits_of(bits, t);
    }
  }
  EXPECT_EQ(bits, 14094161999459915229u);
}

// Lines anywhere in the unit square, which cross in some hundred points.
Lines crossing_lines(std::uint64_t seed) {
  Lines made;
  for (int i = 0; i < 80; ++i) {
    const auto number = static_cast<std::uint64_t>(2 * i);
    made.points.emplace_back(random_uniform(random_key(seed, number)),
                             random_uniform(random_key(seed, number + 1)));
    if (i % 2 == 1) made.lines.push_back({i - 1, i});
  }
  return made;
}

// Lines of a turned lattice cross in, beside and near points, overlap and repeat each other, all
// within rounding.
Lines turned_lattice(std::uint64_t seed) {
  Lines made;
  const Eigen::Rotation2Dd turned(6.0 * random_uniform(random_key(seed, 1)));
  for (int i = 0; i < 40; ++i) {
    const auto number = static_cast<std::uint64_t>(2 * i + 10);
    made.points.push_back(turned *
                          (0.1 * Vector2d(whole(seed, number, 5), whole(seed, number + 1, 5))));
    if (i > 0) made.lines.push_back({i - 1, i});
  }
  return made;
}

TEST(TriangulationBackend, CrossingLinesAreKeptAndNothingIsLost) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    SCOPED_TRACE(seed);
    for (const Lines& made : {crossing_lines(seed), turned_lattice(seed)}) {
      const PlanarTriangulation t = triangulate(made.points, made.lines);
      // A crossing lies within 2^-50 of its lines, and edges are at most 1.5 long: up to 2000
      // triangles make 3e-12 in all.
      ASSERT_NEAR(twice_area(t), twice_hull_area(made.points), 3e-12);
    }
    const Lines made = crossing_lines(seed);
    const PlanarTriangulation t = triangulate(made.points, made.lines);
    EXPECT_GT(t.points.size(), made.points.size());
    // Each of fewer than 100 pieces of a line ends within 2^-50 of the line: 1e-13. The shortest of
    // 800 lines is longer than 1e-3, the root of the chance of a point near another: 1e-10.
    for (const auto& [a, b] : made.lines) {
      ASSERT_NEAR(covered(t, made.points[a], made.points[b], 1e-13), 1.0, 1e-10);
    }
  }
}

}  // namespace
}  // namespace lightwell::triangulation_backend_test
