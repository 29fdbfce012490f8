#include "mesh/cleaning/hanging_points.h"

#include <algorithm>
#include <utility>

#include "mesh/geometry/box_tree.h"
#include "scene/parallel.h"

namespace lightwell {
namespace {

using Eigen::Vector3d;

constexpr std::int64_t quick = 128;         // nodes of the tree that every edge may visit
constexpr std::int64_t most_per_edge = 16;  // nodes per edge, shared by the edges that need more
constexpr double share_of_length = 1e-3;    // of an edge; no point farther away is inserted
// Facets; more at an edge are a fan, whose corners are not compared.
constexpr std::size_t most_beside_edge = 64;

// An edge of the surface, with the points inside.
struct HangingEdge {
  int low = 0, high = 0;  // points
  int first_use = 0, uses = 0;
  std::vector<int> inside{};  // from low to high
};

class HangingPoints {
 public:
  HangingPoints(const FacetLoops& facets, const std::vector<Vector3d>& points, double tolerance)
      : facets_(facets), points_(points), tolerance_(tolerance), uses_(edge_uses(facets)) {
    for (std::size_t begin = 0, end = 0; begin < uses_.size(); begin = end) {
      while (end < uses_.size() && uses_[end].same_edge(uses_[begin])) ++end;
      edges_.push_back({.low = uses_[begin].low,
                        .high = uses_[begin].high,
                        .first_use = static_cast<int>(begin),
                        .uses = static_cast<int>(end - begin)});
    }
  }

  // At a T-junction at least one side is open: the long edge, or the short ones that end in the
  // point. So open edges are compared with all points, and all edges with open points.
  void find() {
    std::vector<int> open_edges, all_edges, open_points, all_points;
    for (int e = 0; e < static_cast<int>(edges_.size()); ++e) {
      all_edges.push_back(e);
      if (edges_[e].uses != 1) continue;
      open_edges.push_back(e);
      open_points.insert(open_points.end(), {edges_[e].low, edges_[e].high});
    }
    if (open_edges.empty()) return;
    all_points = facets_.corner;
    search(open_edges, std::move(all_points));
    search(all_edges, std::move(open_points));
    for (HangingEdge& edge : edges_) put_in_order(edge);
  }

  FacetLoops result(std::int64_t& hanging) const {
    hanging = 0;
    for (const HangingEdge& edge : edges_) hanging += static_cast<std::int64_t>(edge.inside.size());
    if (hanging == 0) return facets_;
    FacetLoops result;
    std::vector<int> loop;
    for (int f = 0; f < facets_.count(); ++f) {
      for (int l = facets_.facet_begin[f]; l < facets_.facet_begin[f + 1]; ++l) {
        loop.clear();
        const auto corners = facets_.loop(l);
        for (std::size_t i = 0; i < corners.size(); ++i) {
          const int from = corners[i], to = corners[i + 1 < corners.size() ? i + 1 : 0];
          loop.push_back(from);
          const std::vector<int>& inside = edge_between(from, to).inside;
          if (from < to)
            loop.insert(loop.end(), inside.begin(), inside.end());
          else
            loop.insert(loop.end(), inside.rbegin(), inside.rend());
        }
        result.add_loop(loop);
      }
      result.end_facet(facets_.maps[f]);
    }
    return result;
  }

 private:
  const HangingEdge& edge_between(int a, int b) const {
    const std::pair<int, int> ends = std::minmax(a, b);
    return *std::lower_bound(
        edges_.begin(), edges_.end(), ends,
        [](const HangingEdge& e, const auto& key) { return std::pair(e.low, e.high) < key; });
  }

  // Edges that need more than `quick` nodes are left for the end and share a common budget.
  void search(const std::vector<int>& edges, std::vector<int> points) {
    std::sort(points.begin(), points.end());
    points.erase(std::unique(points.begin(), points.end()), points.end());
    std::vector<BoxTree::Box> boxes;
    boxes.reserve(points.size());
    for (const int p : points) boxes.emplace_back(points_[p], points_[p]);
    const BoxTree tree(std::move(boxes));
    const auto try_edge = [&](int e, std::int64_t& visits, std::vector<int>& found) {
      HangingEdge& edge = edges_[e];
      if (!tree.find_along(points_[edge.low], points_[edge.high], tolerance_, visits, found)) {
        return false;
      }
      for (const int i : found) {
        if (is_inside(points[i], edge)) edge.inside.push_back(points[i]);
      }
      return true;
    };
    std::vector<char> is_done(edges.size(), 0);
    parallel_for(static_cast<int>(edges.size()), 256, [&](int begin, int end) {
      std::vector<int> found;
      for (int k = begin; k < end; ++k) {
        std::int64_t visits = quick;
        is_done[k] = try_edge(edges[k], visits, found) ? 1 : 0;
      }
    });
    std::int64_t visits = most_per_edge * static_cast<std::int64_t>(edges_.size());
    std::vector<int> found;
    for (std::size_t k = 0; k < edges.size() && visits > 0; ++k) {
      if (!is_done[k]) try_edge(edges[k], visits, found);
    }
  }

  bool is_inside(int p, const HangingEdge& edge) const {
    if (p == edge.low || p == edge.high) return false;
    const Vector3d d = points_[edge.high] - points_[edge.low], q = points_[p] - points_[edge.low];
    const double length = d.norm(), along = d.dot(q) / length;
    const double near = std::min(tolerance_, share_of_length * length);
    if (!(along > near && length - along > near && (q - along / length * d).norm() <= near)) {
      return false;
    }
    if (edge.uses > static_cast<int>(most_beside_edge)) return false;
    for (int u = edge.first_use; u < edge.first_use + edge.uses; ++u) {
      bool is_own = false;
      facets_.for_each_edge(uses_[u].facet, [&](int corner, int) { is_own |= corner == p; });
      if (is_own) return false;
    }
    return true;
  }

  void put_in_order(HangingEdge& edge) const {
    if (edge.inside.empty()) return;
    const Vector3d& from = points_[edge.low];
    std::sort(edge.inside.begin(), edge.inside.end(), [&](int a, int b) {
      const double s = (points_[a] - from).squaredNorm(), t = (points_[b] - from).squaredNorm();
      return s != t ? s < t : a < b;
    });
    edge.inside.erase(std::unique(edge.inside.begin(), edge.inside.end()), edge.inside.end());
  }

  const FacetLoops& facets_;
  const std::vector<Vector3d>& points_;
  double tolerance_;
  std::vector<EdgeUse> uses_;
  std::vector<HangingEdge> edges_;
};

}  // namespace

FacetLoops with_hanging_points(const FacetLoops& facets, const std::vector<Vector3d>& points,
                               double tolerance, std::int64_t& hanging) {
  HangingPoints search(facets, points, tolerance);
  search.find();
  return search.result(hanging);
}

}  // namespace lightwell
