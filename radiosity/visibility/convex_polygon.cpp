#include "radiosity/visibility/convex_polygon.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <numeric>

#include "mesh/geometry/triangulate.h"
#include "scene/sampling.h"

namespace lightwell {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

// Thickness of an empty part, relative to the other part's depth.
constexpr double thin = 1e-12;
constexpr int most_joined = 12;     // most corners of a piece
constexpr double straight = 1e-10;  // sine of a right turn that still counts as convex

double turn(const Vector2d& a, const Vector2d& b, const Vector2d& c) {
  const Vector2d in = b - a, out = c - b;
  return in.x() * out.y() - in.y() * out.x();
}

bool is_convex_loop(const std::vector<int>& loop, const std::vector<Vector2d>& points) {
  const std::size_t n = loop.size();
  for (std::size_t i = 0; i < n; ++i) {
    const Vector2d &a = points[loop[i]], &b = points[loop[(i + 1) % n]],
                   &c = points[loop[(i + 2) % n]];
    if (turn(a, b, c) < -straight * (b - a).norm() * (c - b).norm()) return false;
  }
  return true;
}

// A star polygon turns left at every corner, too, but by more than 2 pi in total.
bool is_simple_and_convex(const std::vector<Vector2d>& points) {
  std::vector<int> order(points.size());
  std::iota(order.begin(), order.end(), 0);
  double turned = 0.0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Vector2d &a = points[i], &b = points[(i + 1) % points.size()],
                   &c = points[(i + 2) % points.size()];
    turned += std::atan2(turn(a, b, c), (b - a).dot(c - b));
  }
  return turned < 3.0 * std::numbers::pi && is_convex_loop(order, points);
}

// 1 for triangles inside an odd number of loops, 0 for all others.
std::vector<char> inner_triangles(const PlanarTriangulation& mesh) {
  const std::size_t n = mesh.triangles.size();
  std::vector<char> side(n, -1);
  std::vector<int> open;
  for (std::size_t t = 0; t < n; ++t) {
    for (int k = 0; k < 3; ++k) {
      if (mesh.neighbor[t][k] >= 0 || side[t] >= 0) continue;
      side[t] = mesh.constrained[t][k] ? 1 : 0;
      open.push_back(static_cast<int>(t));
    }
  }
  while (!open.empty()) {
    const int t = open.back();
    open.pop_back();
    for (int k = 0; k < 3; ++k) {
      const int next = mesh.neighbor[t][k];
      if (next < 0 || side[next] >= 0) continue;
      side[next] = static_cast<char>(mesh.constrained[t][k] ? 1 - side[t] : side[t]);
      open.push_back(next);
    }
  }
  return side;
}

// Removes inner edges, longest first, as long as the joined pieces stay convex.
class Joiner {
 public:
  explicit Joiner(const PlanarTriangulation& mesh) : mesh_(mesh) {
    const std::vector<char> inside = inner_triangles(mesh);
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
      piece_of_.push_back(static_cast<int>(t));
      const auto& c = mesh.triangles[t];
      pieces_.push_back(inside[t] == 1 ? std::vector<int>(c.begin(), c.end()) : std::vector<int>{});
    }
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
      for (int k = 0; k < 3; ++k) {
        const int other = mesh.neighbor[t][k];
        const bool is_inner = inside[t] == 1 && other > static_cast<int>(t) && inside[other] == 1 &&
                              !mesh.constrained[t][k];
        if (!is_inner) continue;
        const int a = mesh.triangles[t][(k + 1) % 3], b = mesh.triangles[t][(k + 2) % 3];
        edges_.push_back(
            {static_cast<int>(t), other, a, b, (mesh.points[a] - mesh.points[b]).squaredNorm()});
      }
    }
    std::stable_sort(edges_.begin(), edges_.end(),
                     [](const Edge& a, const Edge& b) { return a.length > b.length; });
    for (const Edge& edge : edges_) join(edge);
  }

  const std::vector<std::vector<int>>& pieces() const { return pieces_; }

 private:
  struct Edge {
    int left, right;  // triangles; the edge runs from a to b in the left triangle
    int a, b;
    double length;
  };

  int piece(int triangle) {
    while (piece_of_[triangle] != triangle) triangle = piece_of_[triangle];
    return triangle;
  }

  void join(const Edge& edge) {
    const int left = piece(edge.left), right = piece(edge.right);
    if (left == right || pieces_[left].size() + pieces_[right].size() > most_joined + 2) return;
    // From b once around the left piece to a, then from a around the right piece to b.
    std::vector<int> joined = from(pieces_[left], edge.b);
    const std::vector<int> rest = from(pieces_[right], edge.a);
    if (joined.back() != edge.a || rest.back() != edge.b) return;
    joined.insert(joined.end(), rest.begin() + 1, rest.end() - 1);
    if (!is_convex_loop(joined, mesh_.points)) return;
    pieces_[left] = std::move(joined);
    pieces_[right].clear();
    piece_of_[right] = left;
  }

  static std::vector<int> from(std::vector<int> loop, int start) {
    std::rotate(loop.begin(), std::find(loop.begin(), loop.end(), start), loop.end());
    return loop;
  }

  const PlanarTriangulation& mesh_;
  std::vector<int> piece_of_;
  std::vector<std::vector<int>> pieces_;
  std::vector<Edge> edges_;
};

struct Frame {
  explicit Frame(const Vector3d& normal, const Vector3d& at) : origin(at) {
    tangent_frame(normal, x, y);
  }
  Vector2d flat(const Vector3d& p) const { return {x.dot(p - origin), y.dot(p - origin)}; }
  Vector3d x, y, origin;
};

}  // namespace

bool all_below(std::span<const Vector3d> points, const HalfSpace& plane, double height) {
  return std::all_of(points.begin(), points.end(),
                     [&](const Vector3d& p) { return plane.height(p) <= height; });
}

bool all_above(std::span<const Vector3d> points, const HalfSpace& plane, double height) {
  return std::all_of(points.begin(), points.end(),
                     [&](const Vector3d& p) { return plane.height(p) >= height; });
}

ConvexPolygon::ConvexPolygon(std::span<const Vector3d> corners)
    : count(static_cast<int>(corners.size())) {
  assert(corners.size() <= most_corners);
  std::copy(corners.begin(), corners.end(), corner.begin());
}

ConvexPolygon& ConvexPolygon::operator=(const ConvexPolygon& other) {
  count = other.count;
  std::copy_n(other.corner.begin(), count, corner.begin());
  return *this;
}

double ConvexPolygon::area() const {
  Vector3d sum = Vector3d::Zero();
  for (int i = 2; i < count; ++i) {
    sum += (corner[i - 1] - corner[0]).cross(corner[i] - corner[0]);
  }
  return 0.5 * sum.norm();
}

Cut split(const ConvexPolygon& polygon, const HalfSpace& half_space, ConvexPolygon& inside,
          ConvexPolygon& outside) {
  std::array<double, ConvexPolygon::most_corners> height;
  double highest = 0.0, lowest = 0.0;
  for (int i = 0; i < polygon.count; ++i) {
    height[i] = half_space.height(polygon.corner[i]);
    highest = std::max(highest, height[i]);
    lowest = std::min(lowest, height[i]);
  }
  if (highest <= thin * -lowest) return Cut::none_inside;
  if (-lowest <= thin * highest) return Cut::all_inside;
  inside.count = outside.count = 0;
  for (int i = 0; i < polygon.count; ++i) {
    const int next = i + 1 < polygon.count ? i + 1 : 0;
    const double a = height[i], b = height[next];
    if (a >= 0.0) inside.add(polygon.corner[i]);
    if (a <= 0.0) outside.add(polygon.corner[i]);
    if ((a > 0.0 && b < 0.0) || (a < 0.0 && b > 0.0)) {
      const Vector3d crossing =
          polygon.corner[i] + a / (a - b) * (polygon.corner[next] - polygon.corner[i]);
      inside.add(crossing);
      outside.add(crossing);
    }
  }
  return Cut::both;
}

bool clip(ConvexPolygon& polygon, const HalfSpace& half_space) {
  ConvexPolygon inside, outside;
  switch (split(polygon, half_space, inside, outside)) {
    case Cut::none_inside:
      return false;
    case Cut::both:
      polygon = inside;
      break;
    case Cut::all_inside:
      break;
  }
  return polygon.count >= 3;
}

std::vector<ConvexPolygon> convex_pieces(const std::vector<std::vector<Vector3d>>& loops,
                                         const Vector3d& normal) {
  if (loops.empty()) return {};
  const Frame frame(normal, loops[0][0]);
  std::vector<Vector2d> points;
  std::vector<Vector3d> corners;
  std::vector<std::array<int, 2>> edges;
  for (const auto& loop : loops) {
    const int begin = static_cast<int>(points.size()), n = static_cast<int>(loop.size());
    for (int i = 0; i < n; ++i) {
      points.push_back(frame.flat(loop[i]));
      corners.push_back(loop[i]);
      edges.push_back({begin + i, begin + (i + 1) % n});
    }
  }
  std::vector<ConvexPolygon> pieces;
  if (loops.size() == 1 && static_cast<int>(points.size()) <= most_joined &&
      is_simple_and_convex(points)) {
    pieces.emplace_back(std::span<const Vector3d>(corners));
    return pieces;
  }
  const PlanarTriangulation triangulation = triangulate(points, edges);
  if (!triangulation.is_as_given) return {};
  const Joiner joiner(triangulation);
  for (const std::vector<int>& piece : joiner.pieces()) {
    if (piece.size() < 3) continue;
    ConvexPolygon polygon;
    for (const int v : piece) polygon.add(corners[v]);
    pieces.push_back(polygon);
  }
  return pieces;
}

ConvexPolygon convex_hull(std::span<const Vector3d> points, const Vector3d& normal) {
  ConvexPolygon result;
  if (points.size() < 3) return result;
  const Frame frame(normal, points[0]);
  double size = 0.0;
  for (const Vector3d& p : points) size = std::max(size, (p - points[0]).norm());
  if (!(size > 0.0)) return result;
  // Points are rounded to an integer grid, on which orientation tests are exact.
  constexpr double cells = 1 << 29;
  struct GridPoint {
    std::int64_t x, y;
    const Vector3d* point;
  };
  const auto turns_left = [](const GridPoint& a, const GridPoint& b, const GridPoint& c) {
    return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x) > 0;
  };
  std::vector<GridPoint> grid_points;
  for (const Vector3d& p : points) {
    const Vector2d q = frame.flat(p) * (cells / size);
    grid_points.push_back({std::llround(q.x()), std::llround(q.y()), &p});
  }
  std::sort(grid_points.begin(), grid_points.end(), [](const GridPoint& a, const GridPoint& b) {
    return a.x != b.x ? a.x < b.x : a.y < b.y;
  });
  // Andrew's monotone chain.
  std::vector<GridPoint> hull;
  for (int side = 0; side < 2; ++side) {
    const std::size_t start = hull.size();
    for (const GridPoint& p : grid_points) {
      while (hull.size() >= start + 2 && !turns_left(hull[hull.size() - 2], hull.back(), p)) {
        hull.pop_back();
      }
      hull.push_back(p);
    }
    hull.pop_back();
    std::reverse(grid_points.begin(), grid_points.end());
  }
  constexpr std::size_t most = ConvexPolygon::most_corners - 8;
  if (hull.size() < 3 || hull.size() > most) return result;
  for (const GridPoint& p : hull) result.add(*p.point);
  return result;
}

}  // namespace lightwell
