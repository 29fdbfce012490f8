#include "radiosity/visible_exchange.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>

#include "radiosity/shadowed_polygon.h"

namespace lightwell {
namespace {

using Eigen::Vector3d;

constexpr int most_triangles = 1 << 12;  // bounds the work of a pair at some 10 ms

// Radon's rule of degree 5 in barycentric coordinates: the centroid and two orbits of three points.
// The centroid and either orbit alone make a rule of degree 2: two, for at a bend one of them may
// agree by chance.
struct TriangleRule {
  static constexpr int count = 7;
  std::array<Vector3d, count> at;
  std::array<double, count> weight;
  std::array<std::array<double, count>, 2> within{};  // weights of the rules of degree 2

  TriangleRule() {
    const double root = std::sqrt(15.0);
    at[0] = Vector3d::Constant(1.0 / 3.0);
    weight[0] = 9.0 / 40.0;
    for (int orbit = 0; orbit < 2; ++orbit) {
      const double sign = orbit == 0 ? -1.0 : 1.0;
      const double a = (6.0 + sign * root) / 21.0;
      // Degree 2 of one orbit: 3 w ((1 - 2 a)^2 + 2 a^2 - 1/3) = 1/2 - 1/3.
      const double w = (1.0 / 18.0) / (6.0 * a * a - 4.0 * a + 2.0 / 3.0);
      within[orbit][0] = 1.0 - 3.0 * w;
      for (int k = 0; k < 3; ++k) {
        const int p = 1 + 3 * orbit + k;
        at[p] = Vector3d::Constant(a);
        at[p][k] = 1.0 - 2.0 * a;
        weight[p] = (155.0 + sign * root) / 1200.0;
        within[orbit][p] = w;
      }
    }
  }
};

// Integral over a triangle of what is hidden.
struct Triangle {
  std::array<Vector3d, 3> corner;
  double hidden = 0.0, error = 0.0;
  double least_error = 0.0;   // whatever rules say
  bool is_all_hidden = true;  // from all points of the rule
};

class Integral {
 public:
  Integral(const ShaftEnd& from, const ShaftEnd& to, std::span<const Blocker> blockers)
      : normal_(from.plane.normal), view_(to.parts, blockers), blockers_(blockers) {
    for (const Blocker& blocker : blockers) {
      double area = 0.0;
      for (ConvexPolygon part : from.parts) {
        if (clip_to_reach(part, blocker)) area += part.area();
      }
      reach_area_.push_back(area);
    }
  }

  Triangle over(const std::array<Vector3d, 3>& corner) {
    static const TriangleRule rule;
    Triangle result{.corner = corner};
    const double area = 0.5 * (corner[1] - corner[0]).cross(corner[2] - corner[0]).norm();
    double outer = 0.0, inner = 0.0, most = 0.0, least_hidden = 1.0, most_hidden = 0.0;
    bool is_none_hidden = true, is_any_whole = false;
    std::uint32_t met = 0;
    for (int p = 0; p < TriangleRule::count; ++p) {
      const Vector3d& w = rule.at[p];
      const ShadowedPolygon::View view =
          view_.look(w[0] * corner[0] + w[1] * corner[1] + w[2] * corner[2], normal_);
      result.hidden += area * rule.weight[p] * view.hidden;
      outer += area * rule.within[0][p] * view.hidden;
      inner += area * rule.within[1][p] * view.hidden;
      result.is_all_hidden = result.is_all_hidden && !(view.hidden < view.all);
      is_none_hidden = is_none_hidden && !(view.hidden > 0.0);
      is_any_whole = is_any_whole || view.is_whole;
      least_hidden = std::min(least_hidden, view.hidden);
      most_hidden = std::max(most_hidden, view.hidden);
      most = std::max(most, view.all);
      met |= view.met;
    }
    result.error = std::max(std::abs(result.hidden - outer), std::abs(result.hidden - inner)) +
                   most * missed_area(corner, met);
    const bool is_all_alike = result.is_all_hidden || is_none_hidden;
    if (is_all_alike && met != 0) {
      result.error += area * change_at_corners(corner, result.is_all_hidden);
    }
    // The edge of an umbra or penumbra runs through: no rule is to be believed beyond this.
    constexpr double bend = 0.01;
    if (!is_all_alike && is_any_whole) {
      result.least_error = bend * area * (most_hidden - least_hidden);
      result.error = std::max(result.error, result.least_error);
    }
    return result;
  }

  static bool clip_to_reach(ConvexPolygon& polygon, const Blocker& blocker) {
    for (const HalfSpace& bound : blocker.reach) {
      if (polygon.count >= ConvexPolygon::most_corners) return true;
      if (!clip(polygon, bound)) return false;
    }
    return true;
  }

 private:
  // Where all points of the rule see everything, or all nothing, what they miss begins at a corner:
  // the points from which one blocker hides all make a convex set. The points keep off the corners
  // by a fifth and off the edges by a tenth of the triangle, which bounds the part that is missed.
  double change_at_corners(const std::array<Vector3d, 3>& corner, bool is_all_hidden) {
    constexpr double part = 1.0 / 12.0;
    constexpr double inwards = 1e-3;  // on edges, planes may meet
    const Vector3d middle = (corner[0] + corner[1] + corner[2]) / 3.0;
    double change = 0.0;
    for (const Vector3d& c : corner) {
      const ShadowedPolygon::View view = view_.look(c + inwards * (middle - c), normal_);
      change += is_all_hidden ? view.all - view.hidden : view.hidden;
    }
    return part * change;
  }

  // Area from which blockers hide something that no point of the rule has met. What they hide grows
  // from nothing at the edge of their reach, so a strip of it counts little.
  double missed_area(const std::array<Vector3d, 3>& corner, std::uint32_t met) const {
    if (blockers_.size() < 2) return 0.0;
    double missed = 0.0;
    for (std::size_t k = 0; k < blockers_.size(); ++k) {
      if ((met >> k & 1u) != 0 || !(reach_area_[k] > 0.0)) continue;
      ConvexPolygon part(corner);
      if (!clip_to_reach(part, blockers_[k])) continue;
      const double area = part.area();
      missed += area * area / reach_area_[k];
    }
    return missed;
  }

  Vector3d normal_;
  ShadowedPolygon view_;
  std::span<const Blocker> blockers_;
  std::vector<double> reach_area_;
};

bool hides_all(const Blocker& blocker, const ShaftEnd& from, const ShaftEnd& to) {
  const auto corners_are_before = [](const ShaftEnd& end, const HalfSpace& plane, double sign) {
    return std::all_of(end.corners.begin(), end.corners.end(),
                       [&](const Vector3d& p) { return sign * plane.height(p) >= 0.0; });
  };
  if (blocker.cuts_target || !corners_are_before(from, blocker.plane, 1.0)) return false;
  const ConvexPolygon& polygon = blocker.polygon;
  for (const Vector3d& x : from.corners) {
    for (int k = 0; k < polygon.count; ++k) {
      const Vector3d inwards =
          (polygon.corner[k] - x).cross(polygon.corner[k + 1 < polygon.count ? k + 1 : 0] - x);
      if (!corners_are_before(to, {inwards, inwards.dot(x)}, 1.0)) return false;
    }
  }
  return true;
}

// Cuts all cells by the plane.
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

// The part of `from` from which something may be hidden, cut where that may jump.
std::vector<ConvexPolygon> cells_of(const ShaftEnd& from, const ShaftEnd& to,
                                    std::span<const Blocker> blockers) {
  std::vector<ConvexPolygon> cells;
  for (ConvexPolygon part : from.parts) {
    if (!clip(part, to.plane)) continue;
    std::vector<Vector3d> reached;
    for (const Blocker& blocker : blockers) {
      ConvexPolygon there = part;
      if (!Integral::clip_to_reach(there, blocker)) continue;
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

// Planes through an edge of a blocker and a parallel edge of the target.
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

double error_of(const std::vector<Triangle>& triangles) {
  double error = 0.0;
  for (const Triangle& t : triangles) error += t.error;
  return error;
}

std::vector<Triangle> over_cells(const std::vector<ConvexPolygon>& cells, Integral& integral) {
  std::vector<Triangle> triangles;
  for (const ConvexPolygon& cell : cells) {
    for (int k = 2; k < cell.count; ++k) {
      triangles.push_back(integral.over({cell.corner[0], cell.corner[k - 1], cell.corner[k]}));
    }
  }
  return triangles;
}

std::array<std::array<Vector3d, 3>, 2> halves(const std::array<Vector3d, 3>& corner) {
  int longest = 0;
  double most = 0.0;
  for (int k = 0; k < 3; ++k) {
    const double length = (corner[(k + 1) % 3] - corner[k]).squaredNorm();
    if (length > most) {
      most = length;
      longest = k;
    }
  }
  const Vector3d &a = corner[longest], &b = corner[(longest + 1) % 3],
                 &c = corner[(longest + 2) % 3];
  const Vector3d middle = 0.5 * (a + b);
  return {{{a, middle, c}, {middle, b, c}}};
}

// Halves the worst triangle until the errors add up to the tolerance.
void refine(std::vector<Triangle>& triangles, double tolerance, Integral& integral) {
  // The difference of two rules is the error of the worse; how far a whole is from the sum of its
  // halves shows what the better is off by, but may be small by chance.
  constexpr double trust = 0.1;
  const auto is_better = [](const Triangle& a, const Triangle& b) { return a.error < b.error; };
  std::make_heap(triangles.begin(), triangles.end(), is_better);
  double error = error_of(triangles);
  while (error > tolerance && triangles.size() < most_triangles) {
    std::pop_heap(triangles.begin(), triangles.end(), is_better);
    const Triangle whole = triangles.back();
    triangles.pop_back();
    const auto half = halves(whole.corner);
    std::array<Triangle, 2> parts = {integral.over(half[0]), integral.over(half[1])};
    const double change = std::abs(whole.hidden - parts[0].hidden - parts[1].hidden);
    error -= whole.error;
    for (Triangle& part : parts) {
      const double seen = std::min(part.error, std::max(trust * part.error, 0.5 * change));
      part.error = std::max(part.least_error, seen);
      error += part.error;
      triangles.push_back(part);
      std::push_heap(triangles.begin(), triangles.end(), is_better);
    }
  }
}

}  // namespace

std::optional<VisibleExchange> visible_exchange(const Shafts& shafts, const ShaftEnd& from,
                                                const ShaftEnd& to, std::span<const int> pieces,
                                                double unoccluded, double tolerance) {
  constexpr std::size_t most_pieces = ShadowedPolygon::most_blockers / 2;
  if (pieces.size() > most_pieces || from.parts.empty() || to.parts.empty()) return {};
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
  Integral integral(from, to, blockers);
  std::vector<ConvexPolygon> cells = cells_of(from, to, blockers);
  std::vector<Triangle> triangles = over_cells(cells, integral);
  // A few points on both sides of a bend may agree by chance.
  constexpr double chance = 10.0;
  if (chance * error_of(triangles) > tolerance) {
    cut_where_edges_cover(cells, to, blockers);
    triangles = over_cells(cells, integral);
    refine(triangles, tolerance, integral);
  } else {
    for (Triangle& t : triangles) t.error *= chance;
  }
  double hidden = 0.0;
  bool is_all_hidden = true;
  for (const Triangle& t : triangles) {
    hidden += t.hidden;
    is_all_hidden = is_all_hidden && t.is_all_hidden;
  }
  const double error = error_of(triangles);
  // Seen from nowhere, and what is left is the quadrature's.
  if (is_all_hidden && unoccluded - hidden <= error) return VisibleExchange{};
  return VisibleExchange{std::clamp(unoccluded - hidden, 0.0, unoccluded), error};
}

}  // namespace lightwell
