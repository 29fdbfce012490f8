#include "scene/io/polygon.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "scene/io/flat_loop.h"

namespace lightwell {
namespace {

bool lies_on(const Eigen::Vector2d& p, const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  if (orientation(a, b, p) != 0.0) return false;
  const double along = (p - a).dot(b - a);
  return along >= 0.0 && along <= (b - a).squaredNorm();
}

bool cross_or_touch(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& c,
                    const Eigen::Vector2d& d) {
  if ((a.cwiseMax(b).array() < c.cwiseMin(d).array() - coincidence).any()) return false;
  if ((c.cwiseMax(d).array() < a.cwiseMin(b).array() - coincidence).any()) return false;
  // Most edges with boxes that meet lie clearly on one side of each other.
  const Eigen::Vector2d ab = b - a, ac = c - a, ad = d - a;
  const double at_c = ab.x() * ac.y() - ab.y() * ac.x(), at_d = ab.x() * ad.y() - ab.y() * ad.x();
  const double clear = 2.0 * coincidence * ab.norm();
  if (std::min(at_c, at_d) > clear || std::max(at_c, at_d) < -clear) return false;
  return cross_properly(a, b, c, d) || lies_on(c, a, b) || lies_on(d, a, b) || lies_on(a, c, d) ||
         lies_on(b, c, d);
}

// The fault of a loop whose corners or edges crowd so much that checking them would take minutes.
const char* const is_intricate =
    "has too many corners that lie too close together; cut it into pieces";

std::string loop_fault_within(const FlatLoop& p, PairTests& tests) {
  const std::size_t n = p.size();
  const LoopTree corners = tree_of_corners(p), edges = tree_of_edges(p);
  for (std::size_t i = 0; i < n; ++i) {
    const LoopTree::Box place(p[i]);
    const std::size_t same = corners.find(
        i + 1, [&](const LoopTree::Box& box) { return !are_apart(place, box); },
        [&](std::size_t j) {
          tests.count();
          return (p[i] - p[j]).norm() <= coincidence;
        });
    if (same < n) {
      return fmt::format("has the same point as vertex {} and vertex {}", i + 1, same + 1);
    }
  }
  for (std::size_t i = 0; i < n; ++i) {
    const Eigen::Vector2d &a = p[i], &b = p[(i + 1) % n], &c = p[(i + 2) % n];
    if (orientation(a, b, c) == 0.0 && (b - a).dot(c - b) < 0.0) {
      return fmt::format("folds back on itself at vertex {}", (i + 1) % n + 1);
    }
    const LoopTree::Box about = box_of_edge(p, i);
    const std::size_t met = edges.find(
        i + 2, [&](const LoopTree::Box& box) { return !are_apart(about, box); },
        [&](std::size_t j) {
          tests.count();
          const bool are_neighbours = i == 0 && j == n - 1;
          return !are_neighbours && cross_or_touch(a, b, p[j], p[(j + 1) % n]);
        });
    if (met < n) return fmt::format("has edges {} and {} that cross or touch", i + 1, met + 1);
  }
  return {};
}

std::string loop_fault(const FlatLoop& p) {
  PairTests tests;
  try {
    return loop_fault_within(p, tests);
  } catch (const TooIntricate&) {
    return is_intricate;
  }
}

// True if loop `p` meets the loop `q` with these edges.
bool loops_meet(const FlatLoop& p, const FlatLoop& q, const LoopTree& edges_of_q,
                PairTests& tests) {
  for (std::size_t i = 0; i < p.size(); ++i) {
    const LoopTree::Box about = box_of_edge(p, i);
    const std::size_t met = edges_of_q.find(
        0, [&](const LoopTree::Box& box) { return !are_apart(about, box); },
        [&](std::size_t j) {
          tests.count();
          return cross_or_touch(p[i], p[(i + 1) % p.size()], q[j], q[(j + 1) % q.size()]);
        });
    if (met < q.size()) return true;
  }
  return false;
}

// Eigen::Vector2d in polygon by the even-odd rule; the point must not lie on the loop.
bool is_inside(const Eigen::Vector2d& p, const FlatLoop& loop) {
  bool inside = false;
  for (std::size_t i = 0; i < loop.size(); ++i) {
    const Eigen::Vector2d &a = loop[i], &b = loop[(i + 1) % loop.size()];
    if ((a.y() > p.y()) == (b.y() > p.y())) continue;
    if (p.x() < a.x() + (p.y() - a.y()) / (b.y() - a.y()) * (b.x() - a.x())) inside = !inside;
  }
  return inside;
}

std::string count_fault(const Loop& loop) {
  if (loop.size() >= 3) return {};
  return fmt::format("has {} vertices; a polygon needs at least 3", loop.size());
}

std::string holes_fault(const Polygon& polygon, const LoopPlane& plane, const FlatLoop& boundary) {
  if (polygon.holes.empty()) return {};
  PairTests tests;
  const LoopTree edges = tree_of_edges(boundary);
  std::vector<FlatLoop> holes;
  std::vector<LoopTree> trees;
  for (std::size_t h = 0; h < polygon.holes.size(); ++h) {
    const Loop& hole = polygon.holes[h];
    const auto wrong = [&](const std::string& what) {
      return fmt::format("has hole {}, which {}", h + 1, what);
    };
    if (const auto what = count_fault(hole); !what.empty()) return wrong(what);
    FlatLoop flat = plane.flatten(hole);
    if (const auto what = loop_fault(flat); !what.empty()) return wrong(what);
    if (is_thin(hole)) return wrong("has no area");
    if (loops_meet(flat, boundary, edges, tests)) return wrong("crosses or touches the boundary");
    if (!is_inside(flat.front(), boundary)) return wrong("lies outside the boundary");
    for (std::size_t g = 0; g < holes.size(); ++g) {
      tests.count();
      if (loops_meet(flat, holes[g], trees[g], tests) || is_inside(flat.front(), holes[g]) ||
          is_inside(holes[g].front(), flat)) {
        return wrong(fmt::format("meets hole {}", g + 1));
      }
    }
    trees.push_back(tree_of_edges(flat));
    holes.push_back(std::move(flat));
  }
  return {};
}

}  // namespace

Eigen::Vector3d area_vector(const Loop& loop) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (std::size_t i = 1; i + 1 < loop.size(); ++i) {
    sum += (loop[i] - loop[0]).cross(loop[i + 1] - loop[0]);
  }
  return 0.5 * sum;
}

double size_of(const Loop& loop) {
  const Eigen::Vector3d middle = mean_point(loop);
  double radius = 0.0;
  for (const auto& p : loop) radius = std::max(radius, (p - middle).norm());
  return 2.0 * radius;
}

bool is_thin(const Loop& loop) {
  return !has_area(area_vector(loop).norm(), loop);
}

double deviation_from_plane(const Polygon& polygon) {
  const LoopPlane plane(polygon.boundary);
  double deviation = 0.0;
  const auto add = [&](const Loop& loop) {
    for (const auto& p : loop) {
      deviation = std::max(deviation, std::abs((p - plane.origin).dot(plane.normal)));
    }
  };
  add(polygon.boundary);
  for (const Loop& hole : polygon.holes) add(hole);
  return deviation / plane.size;
}

std::string fault(const Polygon& polygon) {
  if (auto what = count_fault(polygon.boundary); !what.empty()) return what;
  if (!(size_of(polygon.boundary) > 0.0)) return "has all its vertices in one point";
  const LoopPlane plane(polygon.boundary);
  const FlatLoop boundary = plane.flatten(polygon.boundary);
  // A crossing is tested first because the areas of a crossing loop may cancel.
  if (auto what = loop_fault(boundary); !what.empty() && polygon.boundary.size() > 3) return what;
  if (is_thin(polygon.boundary)) return "has no area (it is thinner than 1e-6 of its size)";
  try {
    return holes_fault(polygon, plane, boundary);
  } catch (const TooIntricate&) {
    return is_intricate;
  }
}

}  // namespace lightwell
