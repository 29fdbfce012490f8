#include "mesh/contacts/gap_lines.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "mesh/geometry/cross.h"
#include "scene/rays/float_rounding.h"

namespace lightwell {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

// An edge of a facet above a plane, from the corner of lower number, so that both facets of an edge
// have the same line.
struct EdgeAbove {
  Vector3d start, end;
  double start_height, end_height;  // m, above the plane on the side of the facet

  Vector3d at(double t) const { return start + t * (end - start); }
  double height(double t) const { return start_height + t * (end_height - start_height); }
};

// The part of [0, 1] in which the edge is up to `widest` above the plane; empty if the edge is
// nowhere more than `narrowest` above. A gap that closes is cut as far as its end, where contact
// lines meet: a line that ended a little before would leave elements as narrow as the distance.
std::optional<std::array<double, 2>> part_within(const EdgeAbove& edge, const GapLimits& limits) {
  if (!(std::max(edge.start_height, edge.end_height) > limits.narrowest)) return std::nullopt;
  double from = 0.0, to = 1.0;
  const double slope = edge.end_height - edge.start_height;
  for (const auto& [limit, sign] : {std::pair(0.0, 1.0), {limits.widest, -1.0}}) {
    const double at_start = sign * (edge.start_height - limit), along = sign * slope;
    if (at_start < 0.0 && at_start + along < 0.0) return std::nullopt;
    if (at_start < 0.0) from = std::max(from, -at_start / along);
    if (at_start + along < 0.0) to = std::min(to, -at_start / along);
  }
  if (!(to > from)) return std::nullopt;
  return std::array{from, to};
}

// Distance of q from the boundary of the facet.
double distance_from_boundary(const FacetPlane& facet, const Vector2d& q) {
  double least = std::numeric_limits<double>::infinity();
  facet.for_each_edge([&](int i, int j) {
    least = std::min(least, segment_distance(q, facet.xy[static_cast<std::size_t>(i)],
                                             facet.xy[static_cast<std::size_t>(j)]));
  });
  return least;
}

// The parameters in `within`, its ends included, between which the line p + t d crosses no edge of
// the facet.
std::vector<double> crossings(const FacetPlane& on, const Vector2d& p, const Vector2d& d,
                              const std::array<double, 2>& within) {
  std::vector<double> t{within[0], within[1]};
  on.for_each_edge([&](int k, int l) {
    const Vector2d &a = on.xy[static_cast<std::size_t>(k)], &b = on.xy[static_cast<std::size_t>(l)];
    const double ha = cross(d, a - p), hb = cross(d, b - p);
    if (!(ha * hb < 0.0)) return;
    const Vector2d x = a + ha / (ha - hb) * (b - a);
    const double at = d.dot(x - p) / d.squaredNorm();
    if (at > within[0] && at < within[1]) t.push_back(at);
  });
  std::sort(t.begin(), t.end());
  return t;
}

}  // namespace

double widest_covered(const FacetPlane& facet, const GapLimits& limits) {
  const double boundary = facet.boundary_length(), area = facet.area();
  if (2.0 * area >= limits.least_width * boundary) return limits.widest;
  constexpr double of_a_strip = 1.0 / 3.0;
  if (!(0.5 * boundary >= limits.least_length)) return limits.touching;
  return std::clamp(of_a_strip * 2.0 * area / boundary, limits.touching, limits.widest);
}

std::vector<ContactSegment> gap_lines(const FacetPlane& on, const FacetPlane& over,
                                      const GapLimits& of_all) {
  constexpr double facing = 0.5;  // cosine of 60 degrees
  const double cosine = std::abs(on.normal.dot(over.normal));
  if (cosine < std::min(facing, parallel_cosine)) return {};
  GapLimits limits = of_all;
  limits.widest = widest_covered(over, of_all);
  // A facet that covers no gap hides a parallel one alone.
  if (cosine < (limits.widest > limits.touching ? facing : parallel_cosine)) return {};
  const double side = on.height(over.box.center()) < 0.0 ? -1.0 : 1.0;
  std::vector<ContactSegment> segments;
  over.for_each_edge([&](int i, int j) {
    if (over.point[static_cast<std::size_t>(i)] > over.point[static_cast<std::size_t>(j)]) {
      std::swap(i, j);
    }
    const Vector3d &start = over.corner[static_cast<std::size_t>(i)],
                   &end = over.corner[static_cast<std::size_t>(j)];
    const EdgeAbove edge{start, end, side * on.height(start), side * on.height(end)};
    const auto within = part_within(edge, limits);
    if (!within) return;
    const Vector2d p = on.project(start), d = on.project(end) - p;
    if (!(d.norm() > limits.widest)) return;
    const std::vector<double> t = crossings(on, p, d, *within);
    for (std::size_t k = 0; k + 1 < t.size(); ++k) {
      const double middle = 0.5 * (t[k] + t[k + 1]);
      const double beside = 2.0 * edge.height(middle);
      const Vector2d q = p + middle * d;
      if (!((t[k + 1] - t[k]) * d.norm() > limits.widest)) continue;
      if (!on.contains(q, 0.0) || distance_from_boundary(on, q) < beside) continue;
      segments.push_back({on.lift(p + t[k] * d), on.lift(p + t[k + 1] * d)});
    }
  });
  return segments;
}

}  // namespace lightwell
