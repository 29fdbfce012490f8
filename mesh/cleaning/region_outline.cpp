#include "mesh/cleaning/region_outline.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <tuple>
#include <unordered_map>

#include "mesh/geometry/box_tree.h"
#include "mesh/geometry/cross.h"

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

// Follows edges around into loops. Edges are sorted by their start.
class LoopTracer {
 public:
  LoopTracer(std::vector<RegionEdge> edges, const std::vector<Vector3d>& points,
             const PlaneFrame& frame)
      : edges_(std::move(edges)), used_(edges_.size(), 0), points_(points), frame_(frame) {
    std::sort(edges_.begin(), edges_.end(), [](const RegionEdge& a, const RegionEdge& b) {
      return std::tie(a.from, a.to) < std::tie(b.from, b.to);
    });
  }

  // Appends the loops; returns false if an edge has no successor.
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
  // The first unused edge clockwise from the edge `at`, which bounds the same piece of the region.
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

  // Splits a path at points that it passes again, into loops that touch there.
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

// True if two edges share more than a common end.
bool do_cross(const FlatEdge& e, const FlatEdge& f) {
  const bool from_shared = e.from == f.from || e.from == f.to;
  const bool to_shared = e.to == f.from || e.to == f.to;
  if (from_shared && to_shared) return true;  // one edge twice
  if (from_shared || to_shared) {
    // The edges overlap if they leave the common end in the same direction.
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

template <class Loops>
bool any_cross(const Loops& loops, const std::vector<Vector3d>& points, const PlaneFrame& frame) {
  std::vector<FlatEdge> edges;
  for (const auto& loop : loops) {
    for (std::size_t i = 0; i < loop.size(); ++i) {
      const int a = loop[i], b = loop[(i + 1) % loop.size()];
      edges.push_back({a, b, frame.project(points[a]), frame.project(points[b])});
    }
  }
  constexpr std::size_t few = 24;  // for few edges, testing all pairs is faster than a tree
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
  // The number of times a place is covered is its winding number. With one loop around all others
  // and no crossing, each place inside is covered once.
  if (boundaries != 1 || any_cross(loops, points, frame)) return {};
  return loops;
}

bool do_loops_cross(const std::vector<std::span<const int>>& loops,
                    const std::vector<Vector3d>& points, const Vector3d& normal) {
  return !loops.empty() && any_cross(loops, points, PlaneFrame(points[loops[0][0]], normal));
}

}  // namespace lightwell
