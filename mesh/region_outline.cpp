#include "mesh/region_outline.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <tuple>
#include <unordered_map>

#include "mesh/box_tree.h"
#include "mesh/cross.h"

namespace lightwell {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

class PlaneFrame {
 public:
  PlaneFrame(const Vector3d& origin, const Vector3d& normal) : origin_(origin) {
    x_ = normal.unitOrthogonal();
    y_ = normal.cross(x_);
  }
  Vector2d project(const Vector3d& p) const { return {x_.dot(p - origin_), y_.dot(p - origin_)}; }

 private:
  Vector3d origin_, x_, y_;
};

// Edges sorted by where they start; follows them round.
class LoopTracer {
 public:
  LoopTracer(std::vector<RegionEdge> edges, const std::vector<Vector3d>& points,
             const PlaneFrame& frame)
      : edges_(std::move(edges)), used_(edges_.size(), 0), points_(points), frame_(frame) {
    std::sort(edges_.begin(), edges_.end(), [](const RegionEdge& a, const RegionEdge& b) {
      return std::tie(a.from, a.to) < std::tie(b.from, b.to);
    });
  }

  // False if some edge has no successor.
  bool trace(std::vector<std::vector<int>>& loops) {
    for (std::size_t start = 0; start < edges_.size(); ++start) {
      if (used_[start]) continue;
      std::vector<int> path;
      for (std::size_t at = start;;) {
        used_[at] = 1;
        path.push_back(edges_[at].from);
        if (edges_[at].to == edges_[start].from && next(at) == edges_.size()) break;
        at = next(at);
        if (at == edges_.size()) return false;
      }
      split(path, loops);
    }
    return true;
  }

 private:
  // The first unused edge clockwise from where this one came: it bounds the same piece of the
  // region.
  std::size_t next(std::size_t at) const {
    const int v = edges_[at].to;
    auto i = static_cast<std::size_t>(
        std::lower_bound(edges_.begin(), edges_.end(), v,
                         [](const RegionEdge& e, int point) { return e.from < point; }) -
        edges_.begin());
    std::size_t best = edges_.size();
    double least = INFINITY;
    const Vector2d q = frame_.project(points_[v]);
    const Vector2d back = frame_.project(points_[edges_[at].from]) - q;
    for (; i < edges_.size() && edges_[i].from == v; ++i) {
      if (used_[i]) continue;
      const Vector2d out = frame_.project(points_[edges_[i].to]) - q;
      double turn = std::atan2(cross(out, back), out.dot(back));
      if (!(turn > 0.0)) turn += 2.0 * M_PI;
      if (turn < least) {
        least = turn;
        best = i;
      }
    }
    return best;
  }

  // A path that comes back to a point is two loops that touch there.
  static void split(const std::vector<int>& path, std::vector<std::vector<int>>& loops) {
    std::vector<int> open;
    std::unordered_map<int, std::size_t> place;
    for (const int point : path) {
      const auto known = place.find(point);
      if (known != place.end()) {
        const std::size_t begin = known->second;
        loops.emplace_back(open.begin() + static_cast<std::ptrdiff_t>(begin), open.end());
        for (std::size_t i = begin; i < open.size(); ++i) place.erase(open[i]);
        open.resize(begin);
      }
      place[point] = open.size();
      open.push_back(point);
    }
    loops.push_back(std::move(open));
  }

  std::vector<RegionEdge> edges_;
  std::vector<char> used_;
  const std::vector<Vector3d>& points_;
  const PlaneFrame& frame_;
};

struct FlatEdge {
  int from = 0, to = 0;
  Vector2d a, b;
};

// Whether two edges share more than a common end.
bool do_cross(const FlatEdge& e, const FlatEdge& f) {
  const bool from_shared = e.from == f.from || e.from == f.to;
  const bool to_shared = e.to == f.from || e.to == f.to;
  if (from_shared && to_shared) return true;  // one edge twice
  if (from_shared || to_shared) {
    // From the common end in the same direction: they lie on each other.
    const Vector2d& at = from_shared ? e.a : e.b;
    const Vector2d u = (from_shared ? e.b : e.a) - at;
    const bool at_f_from = f.from == (from_shared ? e.from : e.to);
    const Vector2d v = (at_f_from ? f.b : f.a) - at;
    return cross(u, v) == 0.0 && u.dot(v) > 0.0;
  }
  const auto side = [](const FlatEdge& of, const Vector2d& q) {
    return cross(of.b - of.a, q - of.a);
  };
  const double fa = side(e, f.a), fb = side(e, f.b), ea = side(f, e.a), eb = side(f, e.b);
  if (fa == 0.0 && fb == 0.0) {  // on one line
    const Vector2d d = e.b - e.a;
    const double s = d.dot(f.a - e.a), t = d.dot(f.b - e.a);
    return std::max(s, t) > 0.0 && std::min(s, t) < d.squaredNorm();
  }
  return fa * fb <= 0.0 && ea * eb <= 0.0;
}

bool any_cross(const std::vector<std::vector<int>>& loops, const std::vector<Vector3d>& points,
               const PlaneFrame& frame) {
  std::vector<FlatEdge> edges;
  for (const auto& loop : loops) {
    for (std::size_t i = 0; i < loop.size(); ++i) {
      const int a = loop[i], b = loop[(i + 1) % loop.size()];
      edges.push_back({a, b, frame.project(points[a]), frame.project(points[b])});
    }
  }
  constexpr std::size_t few = 24;  // all pairs are quicker than a tree
  if (edges.size() <= few) {
    for (std::size_t i = 0; i < edges.size(); ++i) {
      for (std::size_t j = i + 1; j < edges.size(); ++j) {
        if (do_cross(edges[i], edges[j])) return true;
      }
    }
    return false;
  }
  std::vector<BoxTree::Box> boxes;
  for (const FlatEdge& e : edges) {
    BoxTree::Box box(Vector3d(e.a.x(), e.a.y(), 0.0));
    boxes.push_back(box.extend(Vector3d(e.b.x(), e.b.y(), 0.0)));
  }
  const BoxTree tree(boxes);
  std::vector<int> found;
  for (std::size_t i = 0; i < edges.size(); ++i) {
    tree.find_overlaps(boxes[i], found);
    for (const int j : found) {
      if (static_cast<std::size_t>(j) > i && do_cross(edges[i], edges[j])) return true;
    }
  }
  return false;
}

// Douglas & Peucker 1973 on the open chain; marks the points to keep. The ends are kept by whoever
// asks.
void keep_corners(const std::vector<int>& chain, const std::vector<Vector3d>& points,
                  std::vector<char>& kept) {
  constexpr double straight = 1e-10;
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
    if (at == begin || (runs_on && farthest <= straight * length)) continue;
    kept[chain[at]] = 1;
    open.emplace_back(begin, at);
    open.emplace_back(at, end);
  }
}

// The loop as chains between kept points; a loop with fewer than two gets them from its shape, so
// that the facet on its other side finds the same.
void keep_loop_corners(std::span<const int> loop, const std::vector<Vector3d>& points,
                       std::vector<char>& kept) {
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
    // One direction for the facets on both sides.
    if (chain.back() < chain.front()) std::reverse(chain.begin(), chain.end());
    keep_corners(chain, points, kept);
  }
}

}  // namespace

std::optional<std::vector<std::vector<int>>> region_loops(std::vector<RegionEdge> edges,
                                                          const std::vector<Vector3d>& points,
                                                          const Vector3d& normal) {
  if (edges.empty()) return {};
  const PlaneFrame frame(points[edges.front().from], normal);
  std::vector<std::vector<int>> loops;
  if (!LoopTracer(std::move(edges), points, frame).trace(loops)) return {};
  std::size_t boundaries = 0;
  for (std::size_t l = 0; l < loops.size(); ++l) {
    const Vector2d origin = frame.project(points[loops[l][0]]);
    double area = 0.0;
    for (std::size_t i = 0; i < loops[l].size(); ++i) {
      area += cross(frame.project(points[loops[l][i]]) - origin,
                    frame.project(points[loops[l][(i + 1) % loops[l].size()]]) - origin);
    }
    if (loops[l].size() < 3 || area == 0.0) return {};
    if (area > 0.0) {
      ++boundaries;
      std::swap(loops[0], loops[l]);
    }
  }
  // With one loop around all others and none crossing, each place is covered once: how often it is
  // covered is its winding number.
  if (boundaries != 1 || any_cross(loops, points, frame)) return {};
  return loops;
}

void straighten(FacetLoops& facets, const std::vector<char>& may_change,
                const std::vector<Vector3d>& points) {
  // A point can go if all its uses are in facets that may change and have the same two neighbours.
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
      keep_loop_corners(facets.loop(l), points, kept);
    }
  }
  FacetLoops result;
  std::vector<int> left;
  for (int f = 0; f < facets.count(); ++f) {
    for (int l = facets.facet_begin[f]; l < facets.facet_begin[f + 1]; ++l) {
      left.clear();
      for (const int v : facets.loop(l)) {
        if (!may_change[f] || kept[v]) left.push_back(v);
      }
      // A needle as thin as what counts as straight stays.
      result.add_loop(left.size() >= 3 ? std::span<const int>(left) : facets.loop(l));
    }
    result.end_facet();
  }
  facets = std::move(result);
}

}  // namespace lightwell
