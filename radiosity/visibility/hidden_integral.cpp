#include "radiosity/visibility/hidden_integral.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace lightwell {
namespace {

using Eigen::Vector3d;

constexpr int most_triangles = 1 << 12;  // bounds the work of a pair at some 10 ms

// Radon's rule of degree 5 in barycentric coordinates: the centroid and two orbits of three points.
// The centroid and either orbit alone make a rule of degree 2. Both of these rules are compared
// with Radon's, since one alone may agree by chance where the integrand bends.
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

}  // namespace

double total_error(std::span<const HiddenTriangle> triangles) {
  double error = 0.0;
  for (const HiddenTriangle& t : triangles) error += t.error;
  return error;
}

HiddenIntegral::HiddenIntegral(const ShaftEnd& from, const ShaftEnd& to,
                               std::span<const Blocker> blockers)
    : normal_(from.plane.normal), view_(to.parts, blockers), blockers_(blockers) {
  for (const Blocker& blocker : blockers) {
    double area = 0.0;
    for (ConvexPolygon part : from.parts) {
      if (clip_to_reach(part, blocker)) area += part.area();
    }
    reach_area_.push_back(area);
  }
}

HiddenTriangle HiddenIntegral::over(const std::array<Vector3d, 3>& corner) {
  static const TriangleRule rule;
  HiddenTriangle result{.corner = corner};
  const double area = 0.5 * (corner[1] - corner[0]).cross(corner[2] - corner[0]).norm();
  double outer = 0.0, inner = 0.0, most = 0.0, least_hidden = 1.0, most_hidden = 0.0;
  bool is_none_hidden = true, is_any_whole = false;
  std::uint32_t met = 0;
  for (int p = 0; p < TriangleRule::count; ++p) {
    const Vector3d& w = rule.at[p];
    const ShadowedPolygon::View view =
        view_.view_from(w[0] * corner[0] + w[1] * corner[1] + w[2] * corner[2], normal_);
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
  // The edge of an umbra or penumbra crosses the triangle: closer agreement of the rules is chance.
  constexpr double bend = 0.01;
  if (!is_all_alike && is_any_whole) {
    result.least_error = bend * area * (most_hidden - least_hidden);
    result.error = std::max(result.error, result.least_error);
  }
  return result;
}

// Error of F_hidden in a triangle where all points of the rule see everything, or all nothing. The
// points from which one blocker hides everything make a convex set, so a region that the rule
// misses begins at a corner. The points of the rule keep away from corners by a fifth and from
// edges by a tenth of the triangle, which bounds the missed region.
double HiddenIntegral::change_at_corners(const std::array<Vector3d, 3>& corner,
                                         bool is_all_hidden) {
  constexpr double part = 1.0 / 12.0;
  constexpr double inwards = 1e-3;  // planes of blockers may meet on edges
  const Vector3d middle = (corner[0] + corner[1] + corner[2]) / 3.0;
  double change = 0.0;
  for (const Vector3d& c : corner) {
    const ShadowedPolygon::View view = view_.view_from(c + inwards * (middle - c), normal_);
    change += is_all_hidden ? view.all - view.hidden : view.hidden;
  }
  return part * change;
}

// Area within reach of blockers that no point of the rule meets, times its share of the blocker's
// whole reach. The hidden form factor grows from 0 at the edge of the reach, so a strip there has
// little effect.
double HiddenIntegral::missed_area(const std::array<Vector3d, 3>& corner, std::uint32_t met) const {
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

void HiddenIntegral::refine(std::vector<HiddenTriangle>& triangles, double tolerance) {
  // The difference of two rules is the error of the worse rule. The difference between a triangle
  // and the sum of its halves shows the error of the better rule, but may be small by chance.
  constexpr double least_error_ratio = 0.1;
  const auto is_better = [](const HiddenTriangle& a, const HiddenTriangle& b) {
    return a.error < b.error;
  };
  std::make_heap(triangles.begin(), triangles.end(), is_better);
  double error = total_error(triangles);
  while (error > tolerance && triangles.size() < most_triangles) {
    std::pop_heap(triangles.begin(), triangles.end(), is_better);
    const HiddenTriangle whole = triangles.back();
    triangles.pop_back();
    const auto half = halves(whole.corner);
    std::array<HiddenTriangle, 2> parts = {over(half[0]), over(half[1])};
    const double change = std::abs(whole.hidden - parts[0].hidden - parts[1].hidden);
    error -= whole.error;
    for (HiddenTriangle& part : parts) {
      const double seen =
          std::min(part.error, std::max(least_error_ratio * part.error, 0.5 * change));
      part.error = std::max(part.least_error, seen);
      error += part.error;
      triangles.push_back(part);
      std::push_heap(triangles.begin(), triangles.end(), is_better);
    }
  }
}

}  // namespace lightwell
