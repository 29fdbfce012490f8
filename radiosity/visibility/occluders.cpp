#include "radiosity/visibility/occluders.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>

#include "mesh/patches/mesh_bounds.h"
#include "mesh/patches/patch_outline.h"
#include "mesh/patches/round_grid.h"
#include "scene/facet_textures.h"

namespace lightwell {
namespace {

using Eigen::Vector3d;

double area_of(const PatchMesh& mesh, const std::vector<int>& elements) {
  double area = 0.0;
  for (const int e : elements) area += mesh.element_area[e];
  return area;
}

// Joins coplanar facets that share edges to sheets. A sheet has the number of one of its facets.
class Sheets {
 public:
  explicit Sheets(const PatchMesh& mesh, double tolerance) : mesh_(mesh), tolerance_(tolerance) {
    int facets = 0;
    for (const int f : mesh.facet) facets = std::max(facets, f + 1);
    elements_.resize(static_cast<std::size_t>(facets));
    plane_.resize(elements_.size());
    sheet_.resize(elements_.size());
    std::iota(sheet_.begin(), sheet_.end(), 0);
    facets_.resize(elements_.size());
    for (std::size_t f = 0; f < facets_.size(); ++f) facets_[f] = {static_cast<int>(f)};
    for (int p = 0; p < mesh.patch_count(); ++p) {
      if (mesh.is_back[p] || round_grid_of(mesh, mesh.facet[mesh.first_element[p]])) continue;
      for (int e = mesh.first_element[p]; e < mesh.first_element[p + 1]; ++e) {
        elements_[mesh.facet[e]].push_back(e);
      }
    }
    for (std::size_t f = 0; f < elements_.size(); ++f) {
      if (!elements_[f].empty()) plane_[f] = plane_through(elements_[f]);
    }
    join_neighbours();
  }

  int facet_count() const { return static_cast<int>(elements_.size()); }
  bool is_polygon(int facet) const { return !elements_[facet].empty(); }
  int sheet(int facet) const { return sheet_[facet]; }
  /// Facets of a sheet.
  const std::vector<int>& facets(int sheet) const { return facets_[sheet]; }
  const std::vector<int>& elements(int facet) const { return elements_[facet]; }
  const HalfSpace& plane(int facet) const { return plane_[facet]; }

 private:
  HalfSpace plane_through(const std::vector<int>& elements) const {
    Vector3d normal = Vector3d::Zero();
    for (const int e : elements) {
      const auto& c = mesh_.corners[e];
      const Vector3d a = mesh_.position(c[0]);
      for (int k = 2; k < mesh_.corner_count(e); ++k) {
        normal += (mesh_.position(c[k - 1]) - a).cross(mesh_.position(c[k]) - a);
      }
    }
    normal.normalize();
    return {normal, normal.dot(mesh_.position(mesh_.corners[elements[0]][0]))};
  }

  bool holds(const HalfSpace& plane, int facet) const {
    return std::all_of(elements_[facet].begin(), elements_[facet].end(), [&](int e) {
      for (int k = 0; k < mesh_.corner_count(e); ++k) {
        if (std::abs(plane.height(mesh_.position(mesh_.corners[e][k]))) > tolerance_) return false;
      }
      return true;
    });
  }

  // Edge of an element, compared by position, so that equal edges of two facets are found together.
  struct Edge {
    Vector3d low, high;
    int facet;
    bool is_reversed;
    auto key() const { return std::tuple(low.x(), low.y(), low.z(), high.x(), high.y(), high.z()); }
  };

  void join_neighbours() {
    std::vector<Edge> edges;
    for (int f = 0; f < facet_count(); ++f) {
      for (const int e : elements_[f]) {
        const int n = mesh_.corner_count(e);
        for (int k = 0; k < n; ++k) {
          const Vector3d a = mesh_.position(mesh_.corners[e][k]);
          const Vector3d b = mesh_.position(mesh_.corners[e][(k + 1) % n]);
          const bool is_reversed =
              std::tuple(b.x(), b.y(), b.z()) < std::tuple(a.x(), a.y(), a.z());
          edges.push_back({is_reversed ? b : a, is_reversed ? a : b, f, is_reversed});
        }
      }
    }
    std::sort(edges.begin(), edges.end(), [](const Edge& a, const Edge& b) {
      return std::tuple(a.key(), a.facet, a.is_reversed) <
             std::tuple(b.key(), b.facet, b.is_reversed);
    });
    for (std::size_t begin = 0, end = 0; begin < edges.size(); begin = end) {
      while (end < edges.size() && edges[end].key() == edges[begin].key()) ++end;
      for (std::size_t a = begin; a < end; ++a) {
        for (std::size_t b = a + 1; b < end; ++b) {
          if (edges[a].is_reversed != edges[b].is_reversed) join(edges[a].facet, edges[b].facet);
        }
      }
    }
  }

  // Joins the sheets of two facets if all facets of the smaller sheet lie in the larger sheet's
  // plane. A sheet keeps the plane of its first facet, so planes do not drift. Since the smaller
  // sheet joins the larger, a facet changes its sheet O(log n) times.
  void join(int a, int b) {
    int to = sheet(a), from = sheet(b);
    if (to == from) return;
    const auto rank = [&](int s) { return std::pair(facets_[s].size(), -s); };
    if (rank(to) < rank(from)) std::swap(to, from);
    if (!(plane_[to].normal.dot(plane_[from].normal) > 0.0)) return;
    const bool is_one_plane = std::all_of(facets_[from].begin(), facets_[from].end(),
                                          [&](int f) { return holds(plane_[to], f); });
    if (!is_one_plane) return;
    for (const int f : facets_[from]) sheet_[f] = to;
    facets_[to].insert(facets_[to].end(), facets_[from].begin(), facets_[from].end());
    facets_[from].clear();
  }

  const PatchMesh& mesh_;
  double tolerance_;
  std::vector<std::vector<int>> elements_;  // per facet: elements of its front
  std::vector<HalfSpace> plane_;
  std::vector<int> sheet_;
  // per sheet; the facet whose plane is the sheet's is first
  std::vector<std::vector<int>> facets_;
};

std::vector<ConvexPolygon> pieces_of(const PatchMesh& mesh, const std::vector<int>& elements,
                                     const Vector3d& normal) {
  std::vector<ConvexPolygon> pieces = convex_pieces(boundary_loops(mesh, elements), normal);
  double area = 0.0;
  for (const ConvexPolygon& piece : pieces) area += piece.area();
  const double wanted = area_of(mesh, elements);
  constexpr double all_of_it = 1e-6;
  if (std::abs(area - wanted) <= all_of_it * wanted) return pieces;
  // The areas differ where elements overlap or an outline touches itself: every element is a piece.
  pieces.clear();
  for (const int e : elements) {
    ConvexPolygon polygon;
    for (int k = 0; k < mesh.corner_count(e); ++k) {
      polygon.add(mesh.position(mesh.corners[e][k]));
    }
    pieces.push_back(polygon);
  }
  return pieces;
}

}  // namespace

Occluders::Occluders(const PatchMesh& mesh) {
  constexpr double touching = 1e-7;
  tolerance = touching * scenery_bounds(mesh).diagonal();
  for (const RoundGrid& grid : mesh.round_grids) round_shapes.push_back(grid.shape);

  const Sheets sheets(mesh, tolerance);
  for (int f = 0; f < sheets.facet_count(); ++f) {
    sheet_of_facet.push_back(sheets.is_polygon(f) ? sheets.sheet(f) : -1);
  }
  for (int s = 0; s < sheets.facet_count(); ++s) {
    std::vector<int> elements;
    for (const int f : sheets.facets(s)) {
      elements.insert(elements.end(), sheets.elements(f).begin(), sheets.elements(f).end());
    }
    if (elements.empty()) continue;
    const bool has_holes = mesh.textures && std::ranges::any_of(sheets.facets(s), [&](int f) {
                             return mesh.textures->has_holes(f);
                           });
    for (const ConvexPolygon& polygon : pieces_of(mesh, elements, sheets.plane(s).normal)) {
      Occluder piece{
          .polygon = polygon, .plane = sheets.plane(s), .sheet = s, .has_holes = has_holes};
      for (const Vector3d& v : polygon.corners()) piece.box.extend(v);
      pieces.push_back(piece);
    }
  }
}

}  // namespace lightwell
