#include "mesh/cleaning/straighten.h"

#include <algorithm>
#include <span>
#include <tuple>

#include "mesh/cleaning/region_outline.h"
#include "scene/parallel.h"

namespace lightwell {
namespace {

using Eigen::Vector3d;

// Marks the inner points of the open chain that have to stay; the caller keeps the ends.
void keep_corners(const std::vector<int>& chain, const std::vector<Vector3d>& points,
                  double tolerance, std::vector<char>& kept) {
  std::vector<std::pair<std::size_t, std::size_t>> open{{0, chain.size() - 1}};
  while (!open.empty()) {
    const auto [begin, end] = open.back();
    open.pop_back();
    const Vector3d &a = points[chain[begin]], d = points[chain[end]] - a;
    const double length = d.norm();
    double farthest = -1.0;
    std::size_t at = begin;
    double before = 0.0;
    bool runs_on = length > 0.0;
    for (std::size_t i = begin + 1; i < end; ++i) {
      const Vector3d p = points[chain[i]] - a;
      const double distance = length > 0.0 ? p.cross(d).norm() / length : p.norm();
      if (distance > farthest) {
        farthest = distance;
        at = i;
      }
      const double along = p.dot(d);
      runs_on = runs_on && along > before && along < length * length;
      before = along;
    }
    constexpr double share_of_length = 1e-3;
    const double straight = std::min(tolerance, share_of_length * length);
    if (at == begin || (runs_on && farthest <= straight)) continue;
    kept[chain[at]] = 1;
    open.emplace_back(begin, at);
    open.emplace_back(at, end);
  }
}

// Marks the points of a loop that have to stay, chain by chain between kept points. A loop with
// fewer than two kept points gets them from its shape, so that the facet on the other side finds
// the same.
void keep_loop_corners(std::span<const int> loop, const std::vector<Vector3d>& points,
                       double tolerance, std::vector<char>& kept) {
  const auto is_before = [&](int a, int b) {
    const Vector3d &p = points[a], &q = points[b];
    return std::tuple(p.x(), p.y(), p.z(), a) < std::tuple(q.x(), q.y(), q.z(), b);
  };
  const auto count = std::count_if(loop.begin(), loop.end(), [&](int v) { return kept[v] != 0; });
  if (count == 0) kept[*std::min_element(loop.begin(), loop.end(), is_before)] = 1;
  if (count < 2) {
    const int one = *std::find_if(loop.begin(), loop.end(), [&](int v) { return kept[v] != 0; });
    kept[*std::max_element(loop.begin(), loop.end(), [&](int a, int b) {
      const double s = (points[a] - points[one]).squaredNorm(),
                   t = (points[b] - points[one]).squaredNorm();
      return s != t ? s < t : is_before(a, b);
    })] = 1;
  }
  const std::size_t n = loop.size();
  std::size_t start = 0;
  while (!kept[loop[start]]) ++start;
  for (std::size_t i = 0; i < n;) {
    std::vector<int> chain{loop[(start + i) % n]};
    do {
      ++i;
      chain.push_back(loop[(start + i) % n]);
    } while (!kept[chain.back()]);
    if (chain.size() == 2) continue;
    // The chain has one direction for the facets on both sides.
    if (chain.back() < chain.front()) std::reverse(chain.begin(), chain.end());
    keep_corners(chain, points, tolerance, kept);
  }
}

// Marks the points that have to stay.
std::vector<char> find_kept(const FacetLoops& facets, const std::vector<char>& may_change,
                            const std::vector<Vector3d>& points, double tolerance) {
  // A point may go if all its uses are in facets that may change and have the same two neighbours.
  struct Neighbours {
    int low = -1, high = -1;
  };
  std::vector<Neighbours> neighbours(points.size());
  std::vector<char> kept(points.size(), 0);
  for (int f = 0; f < facets.count(); ++f) {
    for (int l = facets.facet_begin[f]; l < facets.facet_begin[f + 1]; ++l) {
      const auto loop = facets.loop(l);
      const std::size_t n = loop.size();
      for (std::size_t i = 0; i < n; ++i) {
        const auto [low, high] = std::minmax(loop[(i + n - 1) % n], loop[(i + 1) % n]);
        Neighbours& at = neighbours[loop[i]];
        const bool is_new = at.low < 0;
        if (is_new) at = {low, high};
        if (!may_change[f] || at.low != low || at.high != high) kept[loop[i]] = 1;
      }
    }
  }
  for (int f = 0; f < facets.count(); ++f) {
    if (!may_change[f]) continue;
    for (int l = facets.facet_begin[f]; l < facets.facet_begin[f + 1]; ++l) {
      keep_loop_corners(facets.loop(l), points, tolerance, kept);
    }
  }
  return kept;
}

FacetLoops with_kept(const FacetLoops& facets, const std::vector<char>& may_change,
                     const std::vector<char>& kept) {
  FacetLoops result;
  std::vector<int> left;
  for (int f = 0; f < facets.count(); ++f) {
    for (int l = facets.facet_begin[f]; l < facets.facet_begin[f + 1]; ++l) {
      left.clear();
      for (const int v : facets.loop(l)) {
        if (!may_change[f] || kept[v]) left.push_back(v);
      }
      // A needle thinner than the tolerance keeps its corners.
      result.add_loop(left.size() >= 3 ? std::span<const int>(left) : facets.loop(l));
    }
    result.end_facet(facets.maps[f]);
  }
  return result;
}

// Marks the facets with fewer corners than before and a boundary that crosses itself.
std::vector<char> find_spoilt(const FacetLoops& before, const FacetLoops& after,
                              const std::vector<Vector3d>& points) {
  std::vector<char> is_spoilt(static_cast<std::size_t>(after.count()), 0);
  parallel_for(after.count(), 64, [&](int begin, int end) {
    for (int f = begin; f < end; ++f) {
      std::vector<std::span<const int>> loops;
      bool has_changed = false;
      for (int l = after.facet_begin[f]; l < after.facet_begin[f + 1]; ++l) {
        loops.push_back(after.loop(l));
        has_changed = has_changed || after.loop(l).size() != before.loop(l).size();
      }
      if (!has_changed) continue;
      const Vector3d normal = area_vector(after, f, points).normalized();
      is_spoilt[f] = normal.isZero() || do_loops_cross(loops, points, normal) ? 1 : 0;
    }
  });
  return is_spoilt;
}

}  // namespace

void straighten(FacetLoops& facets, const std::vector<char>& may_change,
                const std::vector<Vector3d>& points, double tolerance) {
  std::vector<char> kept = find_kept(facets, may_change, points, tolerance);
  for (;;) {
    FacetLoops straight = with_kept(facets, may_change, kept);
    const std::vector<char> is_spoilt = find_spoilt(facets, straight, points);
    if (std::count(is_spoilt.begin(), is_spoilt.end(), 1) == 0) {
      facets = std::move(straight);
      return;
    }
    for (int f = 0; f < facets.count(); ++f) {
      if (!is_spoilt[f]) continue;
      facets.for_each_edge(f, [&](int point, int) { kept[point] = 1; });
    }
  }
}

}  // namespace lightwell
