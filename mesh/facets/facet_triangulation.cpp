#include "mesh/facets/facet_triangulation.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <unordered_map>

#include "mesh/facets/crossing_lines.h"
#include "mesh/facets/graded_cells.h"
#include "mesh/facets/graded_points.h"
#include "mesh/facets/inner_points.h"
#include "mesh/geometry/cross.h"

namespace lightwell {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using Pair = std::array<int, 2>;

LocalLines local_lines(const FacetPlane& plane, const FacetOutline& outline,
                       const std::vector<Vector3d>& points) {
  LocalLines lines;
  std::unordered_map<int, int> local;
  const auto number = [&](int p) {
    const auto [entry, is_new] = local.try_emplace(p, static_cast<int>(lines.point.size()));
    if (is_new) {
      lines.point.push_back(p);
      lines.xy.push_back(plane.project(points[p]));
    }
    return entry->second;
  };
  // A boundary may run along one line forth and back, as the bridge to a hole does. Both sides of
  // the line are inside then, so a line passed an even number of times is no border.
  std::map<Pair, int> passes;
  for (const auto& loop : outline.loops) {
    for (std::size_t i = 0; i < loop.size(); ++i) {
      const int a = number(loop[i]), b = number(loop[(i + 1) % loop.size()]);
      ++passes[{std::min(a, b), std::max(a, b)}];
    }
  }
  for (const auto& [line, count] : passes) {
    if (count % 2 == 1) lines.boundary.push_back(line);
  }
  for (const Vector2d& q : lines.xy) lines.box.extend(q);
  lines.all = lines.boundary;
  for (const auto& [a, b] : outline.contacts) lines.all.push_back({number(a), number(b)});
  lines.hard_count = static_cast<int>(lines.all.size());
  for (const auto& [p, q] : outline.creases) {
    const int a = number(p), b = number(q);
    lines.all.push_back({a, b});
    lines.creases.insert({std::min(a, b), std::max(a, b)});
  }
  return lines;
}

CellGrid cell_grid(const Eigen::AlignedBox2d& box, const CutSize& size) {
  return {box, size.pieces(box.sizes().x()), size.pieces(box.sizes().y())};
}

// Marks the triangles inside the polygon by parity: each border line crossed on the way in from
// outside changes sides. Parity is combinatorial, hence right even for the slivers that rounding
// leaves along a divided edge, whose centres no geometric test can place.
std::vector<char> inside_by_parity(const PlanarTriangulation& t,
                                   const std::vector<Pair>& boundary) {
  const std::set<Pair> border(boundary.begin(), boundary.end());
  const auto crosses_border = [&](int triangle, int i) {
    if (!t.constrained[triangle][i]) return false;
    const int a = t.triangles[triangle][(i + 1) % 3], b = t.triangles[triangle][(i + 2) % 3];
    return border.contains({std::min(a, b), std::max(a, b)});
  };
  const int count = static_cast<int>(t.triangles.size());
  constexpr char unknown = 2;
  std::vector<char> inside(count, unknown);
  std::vector<int> open;
  for (int i = 0; i < count; ++i) {
    for (int c = 0; c < 3; ++c) {
      if (t.neighbor[i][c] >= 0 || inside[i] != unknown) continue;
      inside[i] = crosses_border(i, c) ? 1 : 0;
      open.push_back(i);
    }
  }
  while (!open.empty()) {
    const int current = open.back();
    open.pop_back();
    for (int c = 0; c < 3; ++c) {
      const int next = t.neighbor[current][c];
      if (next < 0 || inside[next] != unknown) continue;
      inside[next] = static_cast<char>(inside[current] ^ (crosses_border(current, c) ? 1 : 0));
      open.push_back(next);
    }
  }
  return inside;
}

// Distance below which rounding alone sets points of the facet apart, m. A point is lifted from the
// plane by two products, and found on two lines by two more: each is rounded by 2^-53 of the
// coordinates at most, and so are the sums.
double place_rounding(const FacetPlane& plane) {
  constexpr double roundings = 8.0;
  const double farthest =
      plane.box.min().cwiseAbs().cwiseMax(plane.box.max().cwiseAbs()).maxCoeff();
  return roundings * std::ldexp(farthest, -53);
}

// Marks the triangles whose centres lie inside the polygon, for polygons that cross themselves, and
// for the rare case that lines had to be cut because rounding makes them cross.
std::vector<char> inside_by_place(const FacetPlane& plane, const PlanarTriangulation& t) {
  std::vector<char> inside;
  for (const auto& [a, b, c] : t.triangles) {
    const Vector2d center = (t.points[a] + t.points[b] + t.points[c]) / 3.0;
    inside.push_back(plane.winds_round(center) ? 1 : 0);
  }
  // Rounding decides on which side of the boundary a flat triangle's centre is. The triangle
  // belongs to what lies across its longest edge.
  const double rounding = place_rounding(plane);
  for (std::size_t i = 0; i < inside.size(); ++i) {
    const int apex = flat_corner(t, static_cast<int>(i), rounding);
    if (apex < 0 || t.constrained[i][apex]) continue;
    const int across = t.neighbor[i][apex];
    inside[i] = across < 0 ? 0 : inside[across];
  }
  return inside;
}

// Leaves out triangles without area, which lines that cross near their ends make.
void drop_flat(const PlanarTriangulation& t, std::vector<char>& inside) {
  constexpr double flat = 1e-12;  // height over length
  for (std::size_t i = 0; i < inside.size(); ++i) {
    const auto& [a, b, c] = t.triangles[i];
    const Vector2d u = t.points[b] - t.points[a], v = t.points[c] - t.points[a];
    const double longest = std::max({u.squaredNorm(), v.squaredNorm(), (u - v).squaredNorm()});
    if (!(cross(u, v) > flat * longest)) inside[i] = 0;
  }
}

// Triangulates on coordinates rounded to 2^-30 = 1e-9 of an element. The corners of a square are
// then exactly cocircular whatever rounding did before, so the mesh is the same in every unit and
// at every place. Where the rounding turns a triangle over, the unrounded coordinates are
// triangulated.
PlanarTriangulation triangulate_places(const std::vector<Vector2d>& xy, const LocalLines& lines,
                                       double element_size, double rounding) {
  const double unit = element_size * std::ldexp(1.0, -30);
  std::vector<Vector2d> rounded;
  for (const Vector2d& q : xy) {
    const Eigen::Array2d cells = (q - lines.box.min()).array() / unit;
    rounded.emplace_back(std::round(cells.x()), std::round(cells.y()));
  }
  PlanarTriangulation t = triangulate(rounded, lines.all);
  if (!t.is_as_given) return triangulate_crossing(xy, lines.all, rounding);
  t.points = xy;
  const std::vector<char> inside = inside_by_parity(t, lines.boundary);
  for (std::size_t i = 0; i < inside.size(); ++i) {
    const auto& [a, b, c] = t.triangles[i];
    const Vector2d u = xy[b] - xy[a], v = xy[c] - xy[a];
    if (inside[i] && !(u.x() * v.y() > u.y() * v.x())) {
      return triangulate_crossing(xy, lines.all, rounding);
    }
  }
  return t;
}

// Adds graded points in rounds; each round lets triangles become about twice as large as those of
// the last.
void grade(const LocalLines& lines, double element_size, double rounding,
           PlanarTriangulation& triangulation, std::vector<char>& inside) {
  constexpr int most_rounds = 8;
  std::size_t left = lines.point.size();  // limit on added points; the elements at most double
  for (int round = 0; round < most_rounds; ++round) {
    const auto added = graded_points(triangulation, inside, lines.all, element_size, left);
    if (added.empty()) return;
    left -= added.size();
    std::vector<Vector2d> xy = triangulation.points;
    xy.insert(xy.end(), added.begin(), added.end());
    PlanarTriangulation next = triangulate_places(xy, lines, element_size, rounding);
    if (!next.is_as_given) return;
    triangulation = std::move(next);
    inside = inside_by_parity(triangulation, lines.boundary);
  }
}

}  // namespace

FacetTriangulation triangulate_facet(const FacetPlane& plane, const FacetOutline& outline,
                                     const std::vector<Vector3d>& points, const FacetSize& size) {
  FacetTriangulation facet{.lines = local_lines(plane, outline, points)};
  const LocalLines& lines = facet.lines;
  std::vector<Vector2d> xy = lines.xy;
  const std::vector<Pair> hard(lines.all.begin(), lines.all.begin() + lines.hard_count),
      creases(lines.all.begin() + lines.hard_count, lines.all.end());
  const double element_size = size.cut.element_size();
  const auto inner =
      size.graded
          ? graded_inner_points({plane, lines.box, *size.graded}, plane, lines.xy, hard, creases)
          : inner_points(cell_grid(lines.box, size.cut), lines.xy, lines.boundary, hard, creases);
  xy.insert(xy.end(), inner.begin(), inner.end());
  PlanarTriangulation& t = facet.triangulation;
  const double rounding = place_rounding(plane);
  t = triangulate_places(xy, lines, element_size, rounding);
  const bool by_parity = t.is_as_given && !outline.crosses_itself;
  facet.inside = by_parity ? inside_by_parity(t, lines.boundary) : inside_by_place(plane, t);
  if (outline.crosses_itself) drop_flat(t, facet.inside);
  // Creases are meant to be divided finely.
  if (by_parity && lines.creases.empty()) grade(lines, element_size, rounding, t, facet.inside);
  return facet;
}

}  // namespace lightwell
