#include "scene/io/polygon.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <set>
#include <tuple>

#include "scene/io/crossing_polygon.h"
#include "scene/io/loop_tree.h"
#include "scene/sampling.h"

namespace lightwell {
namespace {

using Point = Eigen::Vector2d;
using FlatLoop = std::vector<Point>;

// Points closer than this share of the size coincide: far below `flatness`, far above rounding.
constexpr double coincident = 1e-9;

Eigen::Vector3d newell(const Loop& loop) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < loop.size(); ++i) {
    sum += (loop[i] - loop[0]).cross(loop[(i + 1) % loop.size()] - loop[0]);
  }
  return 0.5 * sum;
}

Eigen::Vector3d mean_point(const Loop& loop) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  // Relative to loop[0]: keeps digits far from the origin.
  for (const auto& p : loop) sum += p - loop[0];
  return loop[0] + sum / static_cast<double>(loop.size());
}

// Coordinates in the plane, in which the boundary runs counter-clockwise and has size 1.
struct Plane {
  Eigen::Vector3d origin, normal, x, y;
  double size = 0.0;

  explicit Plane(const Loop& boundary) : size(size_of(boundary)) {
    origin = mean_point(boundary);
    const Eigen::Vector3d area = newell(boundary);
    normal = area.norm() > 0.0 ? Eigen::Vector3d(area.normalized()) : Eigen::Vector3d::UnitZ();
    tangent_frame(normal, x, y);
  }
  FlatLoop flatten(const Loop& loop) const {
    FlatLoop flat;
    for (const auto& p : loop) {
      flat.emplace_back((p - origin).dot(x) / size, (p - origin).dot(y) / size);
    }
    return flat;
  }
};

// Twice the signed area of (a, b, c); 0 if the area is within rounding.
double orientation(const Point& a, const Point& b, const Point& c) {
  const Point ab = b - a, ac = c - a;
  const double area = ab.x() * ac.y() - ab.y() * ac.x();
  return std::abs(area) > coincident * ab.norm() ? area : 0.0;
}

bool lies_on(const Point& p, const Point& a, const Point& b) {
  if (orientation(a, b, p) != 0.0) return false;
  const double along = (p - a).dot(b - a);
  return along >= 0.0 && along <= (b - a).squaredNorm();
}

bool cross_properly(const Point& a, const Point& b, const Point& c, const Point& d) {
  return orientation(a, b, c) * orientation(a, b, d) < 0.0 &&
         orientation(c, d, a) * orientation(c, d, b) < 0.0;
}

bool cross_or_touch(const Point& a, const Point& b, const Point& c, const Point& d) {
  if ((a.cwiseMax(b).array() < c.cwiseMin(d).array() - coincident).any()) return false;
  if ((c.cwiseMax(d).array() < a.cwiseMin(b).array() - coincident).any()) return false;
  // Most edges with boxes that meet lie clearly on one side of each other.
  const Point ab = b - a, ac = c - a, ad = d - a;
  const double at_c = ab.x() * ac.y() - ab.y() * ac.x(), at_d = ab.x() * ad.y() - ab.y() * ad.x();
  const double clear = 2.0 * coincident * ab.norm();
  if (std::min(at_c, at_d) > clear || std::max(at_c, at_d) < -clear) return false;
  return cross_properly(a, b, c, d) || lies_on(c, a, b) || lies_on(d, a, b) || lies_on(a, c, d) ||
         lies_on(b, c, d);
}

bool are_apart(const LoopTree::Box& box, const LoopTree::Box& other) {
  return (box.max().array() < other.min().array() - coincident).any() ||
         (other.max().array() < box.min().array() - coincident).any();
}

LoopTree::Box box_of_edge(const FlatLoop& p, std::size_t i) {
  return LoopTree::Box(p[i]).extend(p[(i + 1) % p.size()]);
}

LoopTree tree_of_edges(const FlatLoop& p) {
  return {p.size(), [&](std::size_t i) { return box_of_edge(p, i); }};
}

LoopTree tree_of_corners(const FlatLoop& p) {
  return {p.size(), [&](std::size_t i) { return LoopTree::Box(p[i]); }};
}

// The fault of a loop whose corners or edges crowd so much that checking them would take minutes.
const char* const is_intricate =
    "has too many corners that lie too close together; cut it into pieces";

// Thrown where the tests of a loop exceed most_pair_tests.
struct TooIntricate {};

// Counts tests of pairs.
class PairTests {
 public:
  void count() {
    if (++count_ > most_pair_tests) throw TooIntricate();
  }

 private:
  std::int64_t count_ = 0;
};

std::string loop_fault_within(const FlatLoop& p, PairTests& tests) {
  const std::size_t n = p.size();
  const LoopTree corners = tree_of_corners(p), edges = tree_of_edges(p);
  for (std::size_t i = 0; i < n; ++i) {
    const LoopTree::Box place(p[i]);
    const std::size_t same = corners.find(
        i + 1, [&](const LoopTree::Box& box) { return !are_apart(place, box); },
        [&](std::size_t j) {
          tests.count();
          return (p[i] - p[j]).norm() <= coincident;
        });
    if (same < n) {
      return fmt::format("has the same point as vertex {} and vertex {}", i + 1, same + 1);
    }
  }
  for (std::size_t i = 0; i < n; ++i) {
    const Point &a = p[i], &b = p[(i + 1) % n], &c = p[(i + 2) % n];
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

bool crosses_itself_properly(const FlatLoop& p, PairTests& tests) {
  const std::size_t n = p.size();
  const LoopTree edges = tree_of_edges(p);
  for (std::size_t i = 0; i + 2 < n; ++i) {
    const LoopTree::Box about = box_of_edge(p, i);
    const std::size_t crossed = edges.find(
        i + 2, [&](const LoopTree::Box& box) { return !are_apart(about, box); },
        [&](std::size_t j) {
          tests.count();
          return cross_properly(p[i], p[i + 1], p[j], p[(j + 1) % n]);
        });
    if (crossed < n) return true;
  }
  return false;
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

// Point in polygon by the even-odd rule; the point must not lie on the loop.
bool is_inside(const Point& p, const FlatLoop& loop) {
  bool inside = false;
  for (std::size_t i = 0; i < loop.size(); ++i) {
    const Point &a = loop[i], &b = loop[(i + 1) % loop.size()];
    if ((a.y() > p.y()) == (b.y() > p.y())) continue;
    if (p.x() < a.x() + (p.y() - a.y()) / (b.y() - a.y()) * (b.x() - a.x())) inside = !inside;
  }
  return inside;
}

std::string count_fault(const Loop& loop) {
  if (loop.size() >= 3) return {};
  return fmt::format("has {} vertices; a polygon needs at least 3", loop.size());
}

std::string holes_fault(const Polygon& polygon, const Plane& plane, const FlatLoop& boundary) {
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

// True if an area (m^2) inside a loop is more than nothing. The test value, twice the area over the
// squared size, is about width over length for a thin strip.
bool has_area(double area, const Loop& loop) {
  const double size = size_of(loop);
  return area > 0.5 * flatness * size * size;
}

bool blocks_ear(const Point& p, const Point& a, const Point& b, const Point& c) {
  if (p == a || p == b || p == c) return false;
  return orientation(a, b, p) >= 0.0 && orientation(b, c, p) >= 0.0 && orientation(c, a, p) >= 0.0;
}

// Cuts the ears of a loop one by one. The first ear from the second corner on is cut, so that a
// quadrilateral is cut along 0-2. A corner is tested again only where a neighbour has gone, or the
// corner that was found in the way of its ear.
class EarClipping {
 public:
  explicit EarClipping(const FlatLoop& p)
      : p_(p), tree_(tree_of_corners(p)), n_(static_cast<int>(p.size())) {
    for (int i = 0; i < n_; ++i) {
      before_.push_back((i + n_ - 1) % n_);
      after_.push_back((i + 1) % n_);
      candidates_.insert(candidates_.end(), i);
    }
    has_gone_.resize(p.size(), 0);
    waiting_.resize(p.size());
  }

  // The triangles; empty if no ear is left before the end.
  std::vector<std::array<int, 3>> triangles(PairTests& tests) {
    std::vector<std::array<int, 3>> result;
    int first = 0;  // of the corners that are left
    for (int left = n_; left >= 3; --left) {
      const int ear = next_ear(first, tests);
      if (ear < 0) return {};
      result.push_back({before(ear), ear, after(ear)});
      cut(ear);
      if (ear == first) first = after(ear);
    }
    return result;
  }

 private:
  int& before(int i) { return before_[static_cast<std::size_t>(i)]; }
  int& after(int i) { return after_[static_cast<std::size_t>(i)]; }
  const Point& at(int i) const { return p_[static_cast<std::size_t>(i)]; }

  int next_ear(int first, PairTests& tests) {
    while (!candidates_.empty()) {
      auto next = candidates_.upper_bound(first);
      if (next == candidates_.end()) next = candidates_.begin();
      if (is_ear(*next, tests)) return *next;
      candidates_.erase(next);
    }
    return -1;
  }

  bool is_ear(int i, PairTests& tests) {
    const Point &a = at(before(i)), &b = at(i), &c = at(after(i));
    tests.count();
    if (!(orientation(a, b, c) > 0.0)) return false;
    const auto in_the_way = tree_.find(
        0, [&](const LoopTree::Box& box) { return may_hold_blocks(box, a, b, c); },
        [&](std::size_t j) {
          tests.count();
          return !has_gone_[j] && blocks_ear(p_[j], a, b, c);
        });
    if (in_the_way == p_.size()) return true;
    waiting_[in_the_way].push_back(i);
    return false;
  }

  // False if a box lies outside one side of a triangle, and farther than orientation() rounds.
  static bool may_hold_blocks(const LoopTree::Box& box, const Point& a, const Point& b,
                              const Point& c) {
    const auto is_outside = [&](const Point& from, const Point& to) {
      const Point side = to - from;
      const Point inmost(side.y() > 0.0 ? box.min().x() : box.max().x(),
                         side.x() > 0.0 ? box.max().y() : box.min().y());
      const Point at = inmost - from;
      return side.x() * at.y() - side.y() * at.x() < -2.0 * coincident * side.norm();
    };
    return !is_outside(a, b) && !is_outside(b, c) && !is_outside(c, a);
  }

  void cut(int ear) {
    const auto e = static_cast<std::size_t>(ear);
    has_gone_[e] = 1;
    candidates_.erase(ear);
    candidates_.insert(before(ear));
    candidates_.insert(after(ear));
    for (const int corner : waiting_[e]) {
      if (!has_gone_[static_cast<std::size_t>(corner)]) candidates_.insert(corner);
    }
    after(before(ear)) = after(ear);
    before(after(ear)) = before(ear);
  }

  const FlatLoop& p_;
  LoopTree tree_;
  int n_;
  std::vector<int> before_, after_;  // neighbours among the corners that are left
  std::vector<char> has_gone_;
  std::vector<std::vector<int>> waiting_;  // by corner: those in whose way it was found
  std::set<int> candidates_;               // corners that may be ears
};

}  // namespace

double size_of(const Loop& loop) {
  const Eigen::Vector3d middle = mean_point(loop);
  double radius = 0.0;
  for (const auto& p : loop) radius = std::max(radius, (p - middle).norm());
  return 2.0 * radius;
}

bool is_thin(const Loop& loop) {
  return !has_area(newell(loop).norm(), loop);
}

double deviation_from_plane(const Polygon& polygon) {
  const Plane plane(polygon.boundary);
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
  const Plane plane(polygon.boundary);
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

std::vector<std::array<int, 3>> split_into_triangles(const Loop& loop) {
  const FlatLoop p = Plane(loop).flatten(loop);
  PairTests of_edges, of_ears;
  try {
    if (crosses_itself_properly(p, of_edges)) return {};
    return EarClipping(p).triangles(of_ears);
  } catch (const TooIntricate&) {
    return {};
  }
}

std::vector<int> MeshBuilder::indices(const Loop& loop) {
  std::vector<int> result;
  for (const auto& p : loop) {
    // Adding 0.0 turns -0 into 0, so that both are one position.
    const std::array<double, 3> key = {p.x() + 0.0, p.y() + 0.0, p.z() + 0.0};
    const auto [found, is_new] = index_of_.emplace(key, static_cast<int>(mesh_.vertices.size()));
    if (is_new) mesh_.vertices.push_back(p);
    result.push_back(found->second);
  }
  return result;
}

namespace {

// Tolerance of texture coordinates: a tenth of a texel in a picture of a thousand.
double uv_tolerance(const UvLoop& uv) {
  Eigen::AlignedBox2d box;
  for (const Eigen::Vector2d& at : uv) box.extend(at);
  return 1e-4 + 1e-3 * box.diagonal().norm();
}

bool agrees(const UvMap& map, const Loop& loop, const UvLoop& uv) {
  const double tolerance = uv_tolerance(uv);
  for (std::size_t i = 0; i < loop.size(); ++i) {
    if (!((map.at(loop[i]) - uv[i]).norm() <= tolerance)) return false;
  }
  return true;
}

// Linear map of corner values over the loop's plane, exact at three corners far from each other.
// The loop may have no area.
template <int size>
struct LinearMap {
  Eigen::Matrix<double, size, 3> gradient;
  Eigen::Matrix<double, size, 1> offset;
};

template <int size>
std::optional<LinearMap<size>> linear_over(
    const Loop& loop, const std::vector<Eigen::Matrix<double, size, 1>>& values) {
  if (values.size() != loop.size()) return std::nullopt;
  std::size_t one = 0, other = 0;
  double farthest = 0.0;
  for (std::size_t i = 1; i < loop.size(); ++i) {
    const double distance = (loop[i] - loop[0]).squaredNorm();
    if (distance > farthest) std::tie(farthest, one) = std::pair(distance, i);
  }
  const Eigen::Vector3d a = loop[one] - loop[0];
  farthest = 0.0;
  for (std::size_t i = 1; i < loop.size(); ++i) {
    const double distance = a.cross(loop[i] - loop[0]).squaredNorm();
    if (distance > farthest) std::tie(farthest, other) = std::pair(distance, i);
  }
  const Eigen::Vector3d b = loop[other] - loop[0], normal = a.cross(b);
  const double area = normal.squaredNorm();
  if (!(area > 0.0)) return std::nullopt;
  // Matrix that maps a to (1, 0), b to (0, 1), and the normal to 0.
  Eigen::Matrix<double, 2, 3> to_sides;
  to_sides << b.cross(normal).transpose() / area, normal.cross(a).transpose() / area;
  Eigen::Matrix<double, size, 2> sides;
  sides << values[one] - values[0], values[other] - values[0];
  LinearMap<size> map{.gradient = sides * to_sides, .offset = {}};
  map.offset = values[0] - map.gradient * loop[0];
  if (!map.gradient.allFinite() || !map.offset.allFinite()) return std::nullopt;
  return map;
}

// Unit normals on the front of the loop; empty if a normal is missing or unusable, or if all equal
// the plane's normal.
NormalLoop bent_normals(const Loop& loop, const NormalLoop& normals) {
  if (normals.size() != loop.size()) return {};
  const Eigen::Vector3d flat = newell(loop).normalized();
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& n : normals) sum += n.stableNormalized();
  const double side = sum.dot(flat) < 0.0 ? -1.0 : 1.0;
  constexpr double straight = 1.0 - 6e-6, grazing = 0.1;  // cosines of 0.2 and 84 degrees
  bool is_flat = true;
  NormalLoop unit;
  for (const Eigen::Vector3d& n : normals) {
    unit.push_back(side * n.stableNormalized());
    const double cosine = unit.back().dot(flat);
    if (!(cosine > grazing)) return {};
    is_flat = is_flat && cosine > straight;
  }
  return is_flat ? NormalLoop{} : unit;
}

// Largest deviation of unit normals from a linear map over a polygon.
constexpr double linear = 2e-3;
// Largest deviation from another facet's map; suits files of four decimals.
constexpr double alike = 3e-4;

bool agrees(const NormalMap& map, const Loop& loop, const NormalLoop& unit, double tolerance) {
  for (std::size_t i = 0; i < loop.size(); ++i) {
    if (!((map.at(loop[i]) - unit[i]).norm() <= tolerance)) return false;
  }
  return true;
}

std::optional<NormalMap> map_of_unit_normals(const Loop& loop, const NormalLoop& unit) {
  const auto found = linear_over<3>(loop, unit);
  if (!found) return std::nullopt;
  const NormalMap map{.gradient = found->gradient, .offset = found->offset};
  return agrees(map, loop, unit, linear) ? std::optional(map) : std::nullopt;
}

}  // namespace

std::optional<UvMap> uv_map_over(const Loop& loop, const UvLoop& uv) {
  const auto found = linear_over<2>(loop, uv);
  if (!found) return std::nullopt;
  const UvMap map{.gradient = found->gradient, .offset = found->offset};
  return agrees(map, loop, uv) ? std::optional(map) : std::nullopt;
}

std::optional<NormalMap> normal_map_over(const Loop& loop, const NormalLoop& normals) {
  const NormalLoop unit = bent_normals(loop, normals);
  return unit.empty() ? std::nullopt : map_of_unit_normals(loop, unit);
}

bool is_even(const Loop& loop, const NormalLoop& normals) {
  const NormalLoop unit = bent_normals(loop, normals);
  return unit.empty() || map_of_unit_normals(loop, unit);
}

// Number of latest maps tried for a new facet: facets of one flat piece are adjacent in files.
constexpr int looked_at = 8;

int MeshBuilder::uv_map(const Loop& loop, const UvLoop& uv) {
  if (uv.empty()) return -1;
  const int count = static_cast<int>(mesh_.uv_maps.size());
  for (int i = count - 1; i >= std::max(0, count - looked_at); --i) {
    if (agrees(mesh_.uv_maps[static_cast<std::size_t>(i)], loop, uv)) return i;
  }
  const auto map = uv_map_over(loop, uv);
  if (!map) return -1;
  mesh_.uv_maps.push_back(*map);
  return count;
}

int MeshBuilder::normal_map(const Loop& loop, const NormalLoop& normals) {
  const NormalLoop unit = bent_normals(loop, normals);
  if (unit.empty()) return -1;
  const int count = static_cast<int>(mesh_.normal_maps.size());
  for (int i = count - 1; i >= std::max(0, count - looked_at); --i) {
    if (agrees(mesh_.normal_maps[static_cast<std::size_t>(i)], loop, unit, alike)) return i;
  }
  const auto map = map_of_unit_normals(loop, unit);
  if (!map) return -1;
  mesh_.normal_maps.push_back(*map);
  return count;
}

void MeshBuilder::add(const Polygon& polygon, const UvLoop& uv, const NormalLoop& normals) {
  Facet facet{.boundary = indices(polygon.boundary),
              .uv_map = uv_map(polygon.boundary, uv),
              .normal_map = normal_map(polygon.boundary, normals)};
  const Eigen::Vector3d normal = newell(polygon.boundary);
  for (const Loop& hole : polygon.holes) {
    facet.holes.push_back(indices(hole));
    if (newell(hole).dot(normal) > 0.0)
      std::reverse(facet.holes.back().begin(), facet.holes.back().end());
  }
  mesh_.facets.push_back(std::move(facet));
}

std::vector<std::string> Repairs::notes() const {
  std::vector<std::string> result;
  const auto add = [&](int count, const char* one, const char* many) {
    if (count > 0) result.push_back(fmt::format("{} {}", count, count == 1 ? one : many));
  };
  add(split, "polygon was not planar and was split into triangles",
      "polygons were not planar and were split into triangles");
  add(thin, "polygon without area was dropped", "polygons without area were dropped");
  add(crossing, "polygon that crosses itself was cut into pieces that do not",
      "polygons that cross themselves were cut into pieces that do not");
  return result;
}

namespace {

// Removes corners that repeat the previous corner.
void join_repeated(Loop& loop, UvLoop& uv, NormalLoop& normals) {
  std::size_t kept = 0;
  for (std::size_t i = 0; i < loop.size(); ++i) {
    if (kept > 0 && loop[i] == loop[kept - 1]) continue;
    if (!uv.empty()) uv[kept] = uv[i];
    if (!normals.empty()) normals[kept] = normals[i];
    loop[kept++] = loop[i];
  }
  while (kept > 1 && loop[0] == loop[kept - 1]) --kept;
  loop.resize(kept);
  if (!uv.empty()) uv.resize(kept);
  if (!normals.empty()) normals.resize(kept);
}

// Values of a loop's corners at the corners of a piece.
template <class Value>
std::vector<Value> values_of(const std::vector<PieceCorner>& piece,
                             const std::vector<Value>& values) {
  std::vector<Value> result;
  for (const PieceCorner& corner : piece) {
    if (!values.empty()) result.push_back(corner.of(values));
  }
  return result;
}

// True if a loop with an area can be a facet as it is.
bool is_sound(const Loop& loop, const UvLoop& uv, const NormalLoop& normals) {
  if (loop.size() > 3 && !(fault({loop}).empty() && deviation_from_plane({loop}) <= flatness)) {
    return false;
  }
  return (uv.empty() || uv_map_over(loop, uv)) && is_even(loop, normals);
}

// Adds the triangles of a loop that have an area.
void add_triangles(MeshBuilder& mesh, const Loop& loop, const UvLoop& uv, const NormalLoop& normals,
                   const std::vector<std::array<int, 3>>& triangles) {
  for (const auto& t : triangles) {
    const Loop corners = {loop[t[0]], loop[t[1]], loop[t[2]]};
    const UvLoop of_corners = uv.empty() ? uv : UvLoop{uv[t[0]], uv[t[1]], uv[t[2]]};
    const NormalLoop normals_there =
        normals.empty() ? normals : NormalLoop{normals[t[0]], normals[t[1]], normals[t[2]]};
    if (!is_thin(corners)) mesh.add({corners}, of_corners, normals_there);
  }
}

}  // namespace

bool add_pieces(MeshBuilder& mesh, const Polygon& polygon, const UvLoop& uv,
                const NormalLoop& normals) {
  Loop all = polygon.boundary;
  for (const Loop& hole : polygon.holes) all.insert(all.end(), hole.begin(), hole.end());
  const auto pieces = convex_pieces(polygon);
  double area = 0.0;
  for (const auto& piece : pieces) area += newell(values_of(piece, all)).norm();
  if (!has_area(area, polygon.boundary)) return false;
  for (const auto& piece : pieces) {
    const Loop corners = values_of(piece, all);
    const UvLoop of_corners = values_of(piece, uv);
    const NormalLoop normals_there = values_of(piece, normals);
    if (is_thin(corners)) continue;
    if (corners.size() == 3 || is_sound(corners, of_corners, normals_there)) {
      mesh.add({corners}, of_corners, normals_there);
    } else {
      add_triangles(mesh, corners, of_corners, normals_there, {{0, 1, 2}, {0, 2, 3}});
    }
  }
  return true;
}

void add_repaired(MeshBuilder& mesh, Loop loop, Repairs& repairs, UvLoop uv, NormalLoop normals) {
  join_repeated(loop, uv, normals);
  const bool thin = loop.size() < 3 || is_thin(loop);
  if (thin && loop.size() <= 3) {
    ++repairs.thin;
    return;
  }
  if (!thin && (loop.size() == 3 || is_sound(loop, uv, normals))) {
    return mesh.add({std::move(loop)}, uv, normals);
  }
  // Some exporters join a hole to its polygon by a bridge, an edge in both directions. Such a loop
  // is no simple polygon, but ear clipping triangulates it.
  const auto triangles = thin ? std::vector<std::array<int, 3>>{} : split_into_triangles(loop);
  if (triangles.empty()) {
    ++(add_pieces(mesh, {loop}, uv, normals) ? repairs.crossing : repairs.thin);
    return;
  }
  if (!is_sound(loop, {}, {})) ++repairs.split;
  add_triangles(mesh, loop, uv, normals, triangles);
}

}  // namespace lightwell
