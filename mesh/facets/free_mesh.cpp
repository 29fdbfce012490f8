#include "mesh/facets/free_mesh.h"

#include <algorithm>
#include <numeric>
#include <optional>
#include <set>

#include "mesh/facets/facet_triangulation.h"
#include "mesh/facets/graded_cells.h"
#include "mesh/facets/group_patches.h"
#include "mesh/facets/inner_points.h"
#include "mesh/facets/pair_triangles.h"
#include "scene/disjoint_sets.h"

namespace lightwell {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using Pair = std::array<int, 2>;

// The cells of a facet's patches: an even grid, or graded cells.
class PatchCells {
 public:
  PatchCells(const FacetPlane& plane, const Eigen::AlignedBox2d& box, const FacetSize& size)
      : even_{box, size.cut.patches(box.sizes().x()), size.cut.patches(box.sizes().y())} {
    if (size.graded) graded_.emplace(plane, box, *size.graded);
  }
  int cell(const Vector2d& q) const { return graded_ ? graded_->cell(q) : even_.cell(q); }
  Vector2d size(int cell) const {
    return graded_ ? Vector2d::Constant(graded_->length(cell)) : Vector2d(even_.dx(), even_.dy());
  }

 private:
  CellGrid even_;
  std::optional<GradedCells> graded_{};
};

// The triangles inside the facet, with split vertices: only triangles connected without crossing a
// contact line share a vertex.
struct SplitTriangles {
  std::vector<std::array<int, 3>> triangles{};
  std::vector<std::array<int, 3>> neighbor{};  // -1 across contact lines and the boundary
  std::vector<std::array<int, 3>> partner{};   // the same, and -1 across creases too
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
  // Corners (3 t + c) are joined across every open edge. A fan of joined corners is one vertex.
  DisjointSets fans(3 * static_cast<std::size_t>(count));
  for (int i = 0; i < count; ++i) {
    for (int c = 0; c < 3; ++c) {
      const int n = split.neighbor[i][c];
      if (n < i) continue;
      for (const int end : {(c + 1) % 3, (c + 2) % 3}) {
        const auto& of_n = source[n];
        const int there =
            static_cast<int>(std::find(of_n.begin(), of_n.end(), source[i][end]) - of_n.begin());
        fans.join(3 * i + end, 3 * n + there);
      }
    }
  }
  std::vector<int> vertex(3 * count, -1);
  for (int i = 0; i < count; ++i) {
    auto& triangle = split.triangles.emplace_back();
    for (int c = 0; c < 3; ++c) {
      int& v = vertex[fans.root(3 * i + c)];
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

// Pairs the triangles into elements, groups these into patches, and orders them by patch.
FacetMesh assemble(const FacetPlane& plane, const SplitTriangles& split, const LocalLines& lines,
                   const std::vector<Vector3d>& points, const PatchCells& patches) {
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
    e.cell_size = patches.size(e.cell);
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
  const std::vector<int> patch = group_patches(placed, contacts);

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

}  // namespace

FacetMesh free_mesh(const FacetPlane& plane, const FacetOutline& outline,
                    const std::vector<Vector3d>& points, const FacetSize& size) {
  const auto [lines, triangulation, inside] = triangulate_facet(plane, outline, points, size);
  // A crease that was cut is not found by its ends.
  if (!triangulation.is_as_given && !lines.creases.empty()) return {};
  const SplitTriangles split = split_at_lines(triangulation, inside, lines.creases);
  if (split.triangles.empty()) return {};
  FacetMesh mesh = assemble(plane, split, lines, points, {plane, lines.box, size});
  mesh.has_cut_lines = !triangulation.is_as_given;
  return mesh;
}

}  // namespace lightwell
