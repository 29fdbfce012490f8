#include "mesh/facets/crossing_lines.h"

#include <algorithm>
#include <set>

#include "mesh/geometry/cross.h"
#include "mesh/geometry/welded_points.h"

namespace lightwell {
namespace {

using Eigen::Vector2d;
using Pair = std::array<int, 2>;

Pair line(int a, int b) {
  return {std::min(a, b), std::max(a, b)};
}

// The points and the pieces of lines of a triangulation in which what rounding set apart is one.
struct JoinedLines {
  std::vector<Vector2d> points{};
  std::set<Pair> lines{};
  bool has_changed = false;  // something was set apart
};

// Numbers of all points of the triangulation among `joined.points`, which gets the points. The
// first `given` are all kept.
std::vector<int> join_points(const PlanarTriangulation& t, int given, double rounding,
                             JoinedLines& joined) {
  WeldedPoints welded(rounding);
  std::vector<int> first, number;  // per welded point, and per point
  for (int i = 0; i < static_cast<int>(t.points.size()); ++i) {
    const Vector2d& at = t.points[static_cast<std::size_t>(i)];
    const auto id = static_cast<std::size_t>(welded.add({at.x(), at.y(), 0.0}, rounding));
    const bool is_new = id == first.size();
    if (is_new) first.push_back(static_cast<int>(joined.points.size()));
    if (is_new || i < given) {
      number.push_back(static_cast<int>(joined.points.size()));
      joined.points.push_back(at);
    } else {
      number.push_back(first[id]);
      joined.has_changed = true;
    }
  }
  return number;
}

JoinedLines join_lines(const PlanarTriangulation& t, int given, double rounding) {
  JoinedLines joined;
  const std::vector<int> number = join_points(t, given, rounding, joined);
  const auto corner = [&](std::size_t triangle, int i) {
    return number[static_cast<std::size_t>(t.triangles[triangle][static_cast<std::size_t>(i % 3)])];
  };
  const auto add = [&](int a, int b) {
    if (a != b) joined.lines.insert(line(a, b));
  };
  for (std::size_t i = 0; i < t.triangles.size(); ++i) {
    for (int c = 0; c < 3; ++c) {
      if (t.constrained[i][static_cast<std::size_t>(c)]) add(corner(i, c + 1), corner(i, c + 2));
    }
  }
  for (std::size_t i = 0; i < t.triangles.size(); ++i) {
    const int apex = flat_corner(t, static_cast<int>(i), rounding);
    if (apex < 0 || !t.constrained[i][static_cast<std::size_t>(apex)]) continue;
    const int at = corner(i, apex), from = corner(i, apex + 1), to = corner(i, apex + 2);
    if (at == from || at == to) continue;
    joined.lines.erase(line(from, to));
    add(from, at);
    add(at, to);
    joined.has_changed = true;
  }
  return joined;
}

}  // namespace

int flat_corner(const PlanarTriangulation& triangulation, int triangle, double rounding) {
  const auto& corners = triangulation.triangles[static_cast<std::size_t>(triangle)];
  const auto at = [&](int i) -> const Vector2d& {
    return triangulation.points[static_cast<std::size_t>(corners[static_cast<std::size_t>(i % 3)])];
  };
  int apex = 0;
  double longest = 0.0;
  for (int i = 0; i < 3; ++i) {
    const double length = (at(i + 2) - at(i + 1)).norm();
    if (length > longest) {
      longest = length;
      apex = i;
    }
  }
  const double twice_area = cross(at(1) - at(0), at(2) - at(0));
  return twice_area <= rounding * longest ? apex : -1;
}

PlanarTriangulation triangulate_crossing(const std::vector<Vector2d>& points,
                                         const std::vector<Pair>& constraints, double rounding) {
  PlanarTriangulation t = triangulate(points, constraints);
  if (t.is_as_given) return t;
  // A line that is moved by the rounding can cross others. Two rounds are usual.
  constexpr int most_rounds = 8;
  for (int round = 0; round < most_rounds; ++round) {
    const JoinedLines joined = join_lines(t, static_cast<int>(points.size()), rounding);
    if (!joined.has_changed) break;
    t = triangulate(joined.points, {joined.lines.begin(), joined.lines.end()});
  }
  t.is_as_given = false;
  return t;
}

}  // namespace lightwell
