#include "mesh/free_mesh.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <set>
#include <unordered_map>

#include "mesh/graded_points.h"
#include "mesh/group_patches.h"
#include "mesh/inner_points.h"
#include "mesh/pair_triangles.h"
#include "mesh/triangulate.h"

namespace lightwell {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using Pair = std::array<int, 2>;

// The lines of an outline over points numbered within the facet.
struct LocalLines {
  std::vector<int> point{};    // number in ContactGraph::points
  std::vector<Vector2d> xy{};  // the same in the facet's frame
  std::vector<Pair> boundary{};
  std::vector<Pair> all{};   // boundary, contacts, creases
  int hard_count = 0;        // of `all`, without the creases
  std::set<Pair> creases{};  // lower number first
  Eigen::AlignedBox2d box{};
};

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
  // A boundary that runs along one line forth and back (the bridge to a hole) has nothing outside
  // there: an even number of passes is no border.
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

CellGrid patch_grid(const Eigen::AlignedBox2d& box, const CutSize& size) {
  return {box, size.patches(box.sizes().x()), size.patches(box.sizes().y())};
}

// Which triangles lie inside the polygon: every border line crossed on the way in from outside
// changes sides. Combinatorial, so right even for the slivers that rounding leaves along a divided
// edge, whose centres no geometric test can place.
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

// The same by geometry, for the rare case that lines had to be cut where they cross by rounding.
std::vector<char> inside_by_place(const FacetPlane& plane, const PlanarTriangulation& t) {
  std::vector<char> inside;
  for (const auto& [a, b, c] : t.triangles) {
    const Vector2d center = (t.points[a] + t.points[b] + t.points[c]) / 3.0;
    inside.push_back(plane.contains(center, 0.0) ? 1 : 0);
  }
  return inside;
}

// The triangles inside, with vertices split so that only triangles connected without crossing a
// line share one.
struct SplitTriangles {
  std::vector<std::array<int, 3>> triangles{};
  std::vector<std::array<int, 3>> neighbor{};  // -1 across contact lines and the boundary
  std::vector<std::array<int, 3>> partner{};   // the same, and -1 across creases
  std::vector<int> source{};                   // point of the triangulation, per vertex
  std::vector<Vector2d> xy{};
};

SplitTriangles split_at_lines(const PlanarTriangulation& t, const std::vector<char>& inside,
                              const std::set<Pair>& creases) {
  std::vector<int> kept(t.triangles.size(), -1);
  int count = 0;
  for (std::size_t i = 0; i < t.triangles.size(); ++i) {
    if (inside[i]) kept[i] = count++;
  }
  SplitTriangles split;
  std::vector<std::array<int, 3>> source;
  for (std::size_t i = 0; i < t.triangles.size(); ++i) {
    if (!inside[i]) continue;
    source.push_back(t.triangles[i]);
    auto& neighbor = split.neighbor.emplace_back();
    auto& partner = split.partner.emplace_back();
    for (int c = 0; c < 3; ++c) {
      const int n = t.neighbor[i][c];
      const int a = t.triangles[i][(c + 1) % 3], b = t.triangles[i][(c + 2) % 3];
      const bool is_line = t.constrained[i][c];
      const bool is_crease = is_line && creases.contains({std::min(a, b), std::max(a, b)});
      neighbor[c] = n < 0 || (is_line && !is_crease) ? -1 : kept[n];
      partner[c] = is_crease ? -1 : neighbor[c];
    }
  }
  // Corners (3 t + c) joined across every open edge: what stays joined is one fan, one vertex.
  std::vector<int> parent(3 * count);
  std::iota(parent.begin(), parent.end(), 0);
  const auto root = [&parent](int i) {
    while (parent[i] != i) i = parent[i] = parent[parent[i]];
    return i;
  };
  for (int i = 0; i < count; ++i) {
    for (int c = 0; c < 3; ++c) {
      const int n = split.neighbor[i][c];
      if (n < i) continue;
      for (const int end : {(c + 1) % 3, (c + 2) % 3}) {
        const auto& of_n = source[n];
        const int there =
            static_cast<int>(std::find(of_n.begin(), of_n.end(), source[i][end]) - of_n.begin());
        const int a = root(3 * i + end), b = root(3 * n + there);
        parent[std::max(a, b)] = std::min(a, b);
      }
    }
  }
  std::vector<int> vertex(3 * count, -1);
  for (int i = 0; i < count; ++i) {
    auto& triangle = split.triangles.emplace_back();
    for (int c = 0; c < 3; ++c) {
      int& v = vertex[root(3 * i + c)];
      if (v < 0) {
        v = static_cast<int>(split.source.size());
        split.source.push_back(source[i][c]);
        split.xy.push_back(t.points[source[i][c]]);
      }
      triangle[c] = v;
    }
  }
  return split;
}

// Elements in the order of their patches, with all that FacetMesh wants.
FacetMesh assemble(const FacetPlane& plane, const SplitTriangles& split, const LocalLines& lines,
                   const std::vector<Vector3d>& points, const CellGrid& patches) {
  const std::vector<int> partner = pair_triangles(split.xy, split.triangles, split.partner);
  const int triangle_count = static_cast<int>(split.triangles.size());
  std::vector<std::array<int, 4>> corners;
  std::vector<PlacedElement> placed;
  std::vector<int> element_of(triangle_count, -1);
  for (int t = 0; t < triangle_count; ++t) {
    if (element_of[t] >= 0) continue;
    const auto& tri = split.triangles[t];
    std::array<int, 4> c{tri[0], tri[1], tri[2], -1};
    element_of[t] = static_cast<int>(corners.size());
    if (partner[t] >= 0) {
      element_of[partner[t]] = element_of[t];
      const auto& n = split.neighbor[t];
      const int opposite = static_cast<int>(std::find(n.begin(), n.end(), partner[t]) - n.begin());
      c = joined_corners(tri, split.triangles[partner[t]], opposite);
    }
    corners.push_back(c);
    PlacedElement& e = placed.emplace_back();
    Vector2d center = Vector2d::Zero();
    const int n = c[3] < 0 ? 3 : 4;
    for (int i = 0; i < n; ++i) {
      const Vector2d &p = split.xy[c[i]], &q = split.xy[c[(i + 1) % n]];
      center += p / n;
      e.box.extend(p);
      e.area += 0.5 * (p.x() * q.y() - q.x() * p.y());
    }
    e.cell = patches.cell(center);
  }
  std::vector<ElementContact> contacts;
  for (int t = 0; t < triangle_count; ++t) {
    for (int c = 0; c < 3; ++c) {
      const int n = split.neighbor[t][c];
      if (n < t || element_of[n] == element_of[t]) continue;
      const auto& tri = split.triangles[t];
      contacts.push_back({element_of[t], element_of[n],
                          (split.xy[tri[(c + 1) % 3]] - split.xy[tri[(c + 2) % 3]]).norm()});
    }
  }
  const std::vector<int> patch =
      group_patches(placed, contacts, Vector2d(patches.dx(), patches.dy()));

  FacetMesh mesh;
  std::vector<int> order(corners.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return patch[a] < patch[b]; });
  for (std::size_t k = 0; k < order.size(); ++k) {
    if (k > 0 && patch[order[k]] != patch[order[k - 1]]) {
      mesh.first_element.push_back(static_cast<int>(k));
    }
    mesh.corners.push_back(corners[order[k]]);
  }
  mesh.first_element.push_back(static_cast<int>(order.size()));
  const auto point_of = [&](int vertex) {
    const int source = split.source[vertex];
    return source < static_cast<int>(lines.point.size()) ? lines.point[source] : -1;
  };
  for (std::size_t v = 0; v < split.source.size(); ++v) {
    const int p = point_of(static_cast<int>(v));
    mesh.position.push_back(p >= 0 ? points[p] : plane.lift(split.xy[v]));
  }
  for (int t = 0; t < triangle_count; ++t) {
    for (int c = 0; c < 3; ++c) {
      if (split.neighbor[t][c] >= 0) continue;
      const int a = split.triangles[t][(c + 1) % 3], b = split.triangles[t][(c + 2) % 3];
      mesh.border.push_back({{a, b}, {point_of(a), point_of(b)}});
    }
  }
  return mesh;
}

// Decides the triangles on coordinates rounded to a billionth of an element: the corners of a
// square then lie on one circle whatever rounding has done to them, so that the mesh is the same in
// every unit and every place. Where that turns a triangle over, the true places decide.
PlanarTriangulation triangulate_places(const std::vector<Vector2d>& xy, const LocalLines& lines,
                                       double element_size) {
  const double unit = element_size * std::ldexp(1.0, -30);
  std::vector<Vector2d> rounded;
  for (const Vector2d& q : xy) {
    const Eigen::Array2d cells = (q - lines.box.min()).array() / unit;
    rounded.emplace_back(std::round(cells.x()), std::round(cells.y()));
  }
  PlanarTriangulation t = triangulate(rounded, lines.all);
  if (!t.is_as_given) return triangulate(xy, lines.all);
  t.points = xy;
  const std::vector<char> inside = inside_by_parity(t, lines.boundary);
  for (std::size_t i = 0; i < inside.size(); ++i) {
    const auto& [a, b, c] = t.triangles[i];
    const Vector2d u = xy[b] - xy[a], v = xy[c] - xy[a];
    if (inside[i] && !(u.x() * v.y() > u.y() * v.x())) return triangulate(xy, lines.all);
  }
  return t;
}

// Each round lets triangles become about twice as large as those of the last.
void grade(const LocalLines& lines, double element_size, PlanarTriangulation& triangulation,
           std::vector<char>& inside) {
  constexpr int most_rounds = 8;
  std::size_t left = lines.point.size();  // twice the elements at most
  for (int round = 0; round < most_rounds; ++round) {
    const auto added = graded_points(triangulation, inside, lines.all, element_size, left);
    if (added.empty()) return;
    left -= added.size();
    std::vector<Vector2d> xy = triangulation.points;
    xy.insert(xy.end(), added.begin(), added.end());
    PlanarTriangulation next = triangulate_places(xy, lines, element_size);
    if (!next.is_as_given) return;
    triangulation = std::move(next);
    inside = inside_by_parity(triangulation, lines.boundary);
  }
}

}  // namespace

FacetMesh free_mesh(const FacetPlane& plane, const FacetOutline& outline,
                    const std::vector<Vector3d>& points, const CutSize& size) {
  const LocalLines lines = local_lines(plane, outline, points);
  std::vector<Vector2d> xy = lines.xy;
  const auto inner = inner_points(cell_grid(lines.box, size), lines.xy, lines.boundary,
                                  {lines.all.begin(), lines.all.begin() + lines.hard_count},
                                  {lines.all.begin() + lines.hard_count, lines.all.end()});
  xy.insert(xy.end(), inner.begin(), inner.end());
  PlanarTriangulation triangulation = triangulate_places(xy, lines, size.element_size());
  // A crease that had to be cut is not known by its ends.
  if (!triangulation.is_as_given && !lines.creases.empty()) return {};
  std::vector<char> inside = triangulation.is_as_given
                                 ? inside_by_parity(triangulation, lines.boundary)
                                 : inside_by_place(plane, triangulation);
  // Creases lie as fine as they should.
  if (triangulation.is_as_given && lines.creases.empty()) {
    grade(lines, size.element_size(), triangulation, inside);
  }
  const SplitTriangles split = split_at_lines(triangulation, inside, lines.creases);
  if (split.triangles.empty()) return {};
  FacetMesh mesh = assemble(plane, split, lines, points, patch_grid(lines.box, size));
  mesh.has_cut_lines = !triangulation.is_as_given;
  return mesh;
}

}  // namespace lightwell
