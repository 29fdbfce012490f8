#include "radiosity/visibility/visible_exchange.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>

#include "radiosity/visibility/hidden_integral.h"

namespace lightwell {
namespace {

using Eigen::Vector3d;

bool hides_all(const Blocker& blocker, const ShaftEnd& from, const ShaftEnd& to) {
  if (blocker.cuts_target || !all_above(from.corners, blocker.plane, 0.0)) return false;
  const ConvexPolygon& polygon = blocker.polygon;
  for (const Vector3d& x : from.corners) {
    for (int k = 0; k < polygon.count; ++k) {
      const Vector3d inwards =
          (polygon.corner[k] - x).cross(polygon.corner[k + 1 < polygon.count ? k + 1 : 0] - x);
      if (!all_above(to.corners, {inwards, inwards.dot(x)}, 0.0)) return false;
    }
  }
  return true;
}

void cut_cells(std::vector<ConvexPolygon>& cells, const HalfSpace& plane) {
  const std::size_t count = cells.size();
  ConvexPolygon inside, outside;
  for (std::size_t c = 0; c < count; ++c) {
    if (cells[c].count >= ConvexPolygon::most_corners) continue;
    if (split(cells[c], plane, inside, outside) != Cut::both) continue;
    cells[c] = inside;
    cells.push_back(outside);
  }
}

// The part of `from` from which something may be hidden, cut along the planes of blockers, at which
// the hidden part may jump.
std::vector<ConvexPolygon> cells_of(const ShaftEnd& from, const ShaftEnd& to,
                                    std::span<const Blocker> blockers) {
  std::vector<ConvexPolygon> cells;
  for (ConvexPolygon part : from.parts) {
    if (!clip(part, to.plane)) continue;
    std::vector<Vector3d> reached;
    for (const Blocker& blocker : blockers) {
      ConvexPolygon there = part;
      if (!clip_to_reach(there, blocker)) continue;
      reached.insert(reached.end(), there.corners().begin(), there.corners().end());
    }
    const ConvexPolygon hull = convex_hull(reached, from.plane.normal);
    if (hull.count >= 3) {
      cells.push_back(hull);
    } else if (!reached.empty()) {
      cells.push_back(part);
    }
  }
  for (const Blocker& blocker : blockers) cut_cells(cells, blocker.plane);
  return cells;
}

// Cuts the cells by the planes through an edge of a blocker and a parallel edge of the target.
void cut_where_edges_cover(std::vector<ConvexPolygon>& cells, const ShaftEnd& to,
                           std::span<const Blocker> blockers) {
  constexpr double parallel = 1e-6;
  constexpr std::size_t most_cells = 256;
  for (const Blocker& blocker : blockers) {
    const ConvexPolygon& polygon = blocker.polygon;
    for (int k = 0; k < polygon.count; ++k) {
      const Vector3d& a = polygon.corner[k];
      const Vector3d edge = polygon.corner[k + 1 < polygon.count ? k + 1 : 0] - a;
      for (const ConvexPolygon& part : to.parts) {
        for (int m = 0; m < part.count; ++m) {
          const Vector3d& b = part.corner[m];
          const Vector3d other = part.corner[m + 1 < part.count ? m + 1 : 0] - b;
          if (edge.cross(other).norm() > parallel * edge.norm() * other.norm()) continue;
          const Vector3d across = edge.cross(b - a);
          if (!(across.norm() > parallel * edge.norm() * (b - a).norm())) continue;
          if (cells.size() < most_cells) cut_cells(cells, {across, across.dot(a)});
        }
      }
    }
  }
}

std::vector<HiddenTriangle> over_cells(const std::vector<ConvexPolygon>& cells,
                                       HiddenIntegral& integral) {
  std::vector<HiddenTriangle> triangles;
  for (const ConvexPolygon& cell : cells) {
    for (int k = 2; k < cell.count; ++k) {
      triangles.push_back(integral.over({cell.corner[0], cell.corner[k - 1], cell.corner[k]}));
    }
  }
  return triangles;
}

}  // namespace

std::optional<VisibleExchange> visible_exchange(const Shafts& shafts, const ShaftEnd& from,
                                                const ShaftEnd& to, std::span<const int> pieces,
                                                double unoccluded, double tolerance) {
  static_assert(2 * most_pieces_between <= ShadowedPolygon::most_blockers);
  if (pieces.size() > most_pieces_between || from.parts.empty() || to.parts.empty()) return {};
  std::vector<Blocker> blockers;
  for (const int p : pieces) {
    for (const int side : {1, -1}) {
      Blocker blocker;
      const double touching = shafts.occluders().tolerance;
      if (!make_blocker(shafts.occluders().pieces[p], side, from, to, touching, blocker)) continue;
      if (hides_all(blocker, from, to)) return VisibleExchange{};
      blockers.push_back(blocker);
    }
  }
  HiddenIntegral integral(from, to, blockers);
  std::vector<ConvexPolygon> cells = cells_of(from, to, blockers);
  std::vector<HiddenTriangle> triangles = over_cells(cells, integral);
  // The estimates of few points on both sides of a bend may be small by chance.
  constexpr double chance = 10.0;
  if (chance * total_error(triangles) > tolerance) {
    cut_where_edges_cover(cells, to, blockers);
    triangles = over_cells(cells, integral);
    integral.refine(triangles, tolerance);
  } else {
    for (HiddenTriangle& t : triangles) t.error *= chance;
  }
  double hidden = 0.0;
  bool is_all_hidden = true;
  for (const HiddenTriangle& t : triangles) {
    hidden += t.hidden;
    is_all_hidden = is_all_hidden && t.is_all_hidden;
  }
  const double error = total_error(triangles);
  // Hidden from every point of the rule: the remainder is quadrature error.
  if (is_all_hidden && unoccluded - hidden <= error) return VisibleExchange{};
  return VisibleExchange{std::clamp(unoccluded - hidden, 0.0, unoccluded), error};
}

}  // namespace lightwell
