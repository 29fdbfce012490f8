#include "viewer/export/chart_plane.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <utility>

#include "mesh/geometry/cross.h"

namespace lightwell {
namespace {

using Eigen::Vector2d;

int corner_count(const std::array<int, 4>& face) {
  return face[3] < 0 ? 3 : 4;
}

// Convex hull by Andrew's monotone chain, counter-clockwise, without points inside edges.
std::vector<Vector2d> flat_hull(std::span<const Vector2d> points) {
  std::vector<Vector2d> sorted(points.begin(), points.end());
  std::sort(sorted.begin(), sorted.end(), [](const Vector2d& a, const Vector2d& b) {
    return std::pair(a.x(), a.y()) < std::pair(b.x(), b.y());
  });
  std::vector<Vector2d> hull;
  for (int pass = 0; pass < 2; ++pass) {
    const std::size_t first = hull.size();
    for (const Vector2d& p : sorted) {
      while (hull.size() >= first + 2 &&
             !(cross(hull.back() - hull[hull.size() - 2], p - hull.back()) > 0.0)) {
        hull.pop_back();
      }
      hull.push_back(p);
    }
    hull.pop_back();  // the other half begins with this point
    std::reverse(sorted.begin(), sorted.end());
  }
  return hull;
}

Vector2d extent(std::span<const Vector2d> points, const Vector2d& x) {
  const Vector2d y(-x.y(), x.x());
  Vector2d low = Vector2d::Constant(std::numeric_limits<double>::infinity()), high = -low;
  for (const Vector2d& p : points) {
    const Vector2d turned(p.dot(x), p.dot(y));
    low = low.cwiseMin(turned);
    high = high.cwiseMax(turned);
  }
  return high - low;
}

Vector2d center_of(const std::array<int, 4>& face, std::span<const Vector2d> places) {
  Vector2d sum = Vector2d::Zero();
  for (int c = 0; c < corner_count(face); ++c) sum += places[face[c]];
  return sum / corner_count(face);
}

struct Segment {
  Vector2d a, b;
  Vector2d nearest(const Vector2d& p) const {
    const Vector2d along = b - a;
    const double t = std::clamp((p - a).dot(along) / along.squaredNorm(), 0.0, 1.0);
    return a + t * along;
  }
};

// Border edges in each cell of a square grid that the edge passes.
class BorderGrid {
 public:
  BorderGrid(const std::vector<BorderEdge>& edges, std::span<const Vector2d> places, double cell)
      : cell_(cell) {
    for (std::size_t i = 0; i < edges.size(); ++i) {
      const Vector2d a = places[edges[i].from], b = places[edges[i].to];
      // Steps are at most a cell long, so that an edge within half a cell of a point is in the
      // point's cell or a neighbour.
      const int steps = 1 + static_cast<int>((b - a).norm() / cell_);
      std::pair<std::int64_t, std::int64_t> last{};
      for (int s = 0; s <= steps; ++s) {
        const auto key = key_of(a + (b - a) * (static_cast<double>(s) / steps));
        if (s == 0 || key != last) cells_[key].push_back(static_cast<int>(i));
        last = key;
      }
    }
  }
  template <class See>
  void near(const Vector2d& p, See&& see) const {
    const auto [x, y] = key_of(p);
    for (std::int64_t dx = -1; dx <= 1; ++dx) {
      for (std::int64_t dy = -1; dy <= 1; ++dy) {
        const auto found = cells_.find({x + dx, y + dy});
        if (found == cells_.end()) continue;
        for (const int i : found->second) see(i);
      }
    }
  }

 private:
  std::pair<std::int64_t, std::int64_t> key_of(const Vector2d& p) const {
    return {static_cast<std::int64_t>(std::floor(p.x() / cell_)),
            static_cast<std::int64_t>(std::floor(p.y() / cell_))};
  }
  double cell_;
  std::map<std::pair<std::int64_t, std::int64_t>, std::vector<int>> cells_{};
};

}  // namespace

Eigen::Vector2d box_direction(std::span<const Eigen::Vector2d> points) {
  const std::vector<Vector2d> hull = flat_hull(points);
  Vector2d best = Vector2d::UnitX();
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < hull.size(); ++i) {
    const Vector2d edge = hull[(i + 1) % hull.size()] - hull[i];
    if (!(edge.norm() > 0.0)) continue;
    const Vector2d x = edge.normalized(), size = extent(hull, x);
    const double area = size.x() * size.y();
    // The two sides of one rectangle differ in area by rounding; the first is kept.
    if (!(area < least * (1.0 - 1e-9))) continue;
    least = area;
    best = size.x() >= size.y() ? x : Vector2d(-x.y(), x.x());
  }
  return best;
}

std::vector<BorderEdge> border_edges(std::span<const std::array<int, 4>> faces,
                                     std::span<const Eigen::Vector2d> places) {
  std::vector<BorderEdge> all;
  for (std::size_t f = 0; f < faces.size(); ++f) {
    const int count = corner_count(faces[f]);
    for (int c = 0; c < count; ++c) {
      all.push_back(
          {.from = faces[f][c], .to = faces[f][(c + 1) % count], .face = static_cast<int>(f)});
    }
  }
  const auto ends = [](const BorderEdge& e) { return std::minmax(e.from, e.to); };
  std::stable_sort(all.begin(), all.end(), [&](const BorderEdge& a, const BorderEdge& b) {
    return std::pair<int, int>(ends(a)) < std::pair<int, int>(ends(b));
  });
  std::vector<BorderEdge> border;
  for (std::size_t i = 0; i < all.size(); ++i) {
    const bool is_shared = (i > 0 && ends(all[i - 1]) == ends(all[i])) ||
                           (i + 1 < all.size() && ends(all[i + 1]) == ends(all[i]));
    const Vector2d along = places[all[i].to] - places[all[i].from];
    if (is_shared || !(along.norm() > 0.0)) continue;
    border.push_back(all[i]);
    border.back().outwards = Vector2d(along.y(), -along.x()).normalized();
  }
  return border;
}

std::vector<CutLine> narrow_gaps(std::span<const std::array<int, 4>> faces,
                                 std::span<const Eigen::Vector2d> places, double gap) {
  constexpr double opposed = -0.5;      // cosine between the outward normals of two borders
  constexpr double least_length = 4.0;  // in gaps; shorter walls darken few texels
  constexpr double no_distance = 1e-6;  // of an edge's length
  const std::vector<BorderEdge> edges = border_edges(faces, places);
  const BorderGrid grid(edges, places, 2.0 * gap);
  std::vector<CutLine> lines;
  for (std::size_t i = 0; i < edges.size(); ++i) {
    const BorderEdge& one = edges[i];
    const Vector2d middle = 0.5 * (places[one.from] + places[one.to]);
    const double length = (places[one.to] - places[one.from]).norm();
    double nearest = gap;
    CutLine line{};
    grid.near(middle, [&](int j) {
      const BorderEdge& other = edges[j];
      const bool is_joined = one.from == other.from || one.from == other.to ||
                             one.to == other.from || one.to == other.to;
      if (is_joined || !(one.outwards.dot(other.outwards) < opposed)) return;
      const Vector2d at = Segment{places[other.from], places[other.to]}.nearest(middle);
      const Vector2d across = at - middle;
      const double distance = across.norm();
      const bool is_seam = distance < no_distance * length;
      if (!(distance < nearest) || (!is_seam && !(length > least_length * gap))) return;
      if (!is_seam && !(across.dot(one.outwards) > 0.5 * distance)) return;
      const CutLine found{.point = 0.5 * (middle + at),
                          .normal = (one.outwards - other.outwards).normalized()};
      const auto side = [&](int face) {
        return (center_of(faces[face], places) - found.point).dot(found.normal);
      };
      if (!(side(one.face) * side(other.face) < 0.0)) return;
      nearest = distance;
      line = found;
    });
    if (nearest < gap) lines.push_back(line);
  }
  return lines;
}

}  // namespace lightwell
