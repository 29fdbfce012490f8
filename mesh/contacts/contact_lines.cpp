#include "mesh/contacts/contact_lines.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <variant>

namespace lightwell {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

// Position of a facet's corners relative to a plane, and the points in which the boundary meets the
// plane.
struct PlaneIntersection {
  bool in_plane = true;    // every corner lies in the plane
  bool can_share = false;  // at least a segment of the facet may lie in the plane
  std::vector<Vector3d> points{};
};

PlaneIntersection intersect_plane(const FacetPlane& facet, const FacetPlane& plane,
                                  double tolerance) {
  PlaneIntersection intersection;
  int above = 0, below = 0, on = 0;
  std::vector<double> height(facet.corner.size());
  for (std::size_t i = 0; i < facet.corner.size(); ++i) {
    height[i] = plane.height(facet.corner[i]);
    if (std::abs(height[i]) <= tolerance) height[i] = 0.0;
    (height[i] > 0.0 ? above : height[i] < 0.0 ? below : on)++;
  }
  intersection.in_plane = above == 0 && below == 0;
  intersection.can_share = (above > 0 && below > 0) || on > 1;
  if (!intersection.can_share || intersection.in_plane) return intersection;
  facet.for_each_edge([&](int i, int j) {
    if (height[i] == 0.0) intersection.points.push_back(facet.corner[i]);
    if (!(height[i] * height[j] < 0.0)) return;
    // Interpolated from the lower-numbered end, so that all facets with the edge get the same bits.
    if (facet.point[i] > facet.point[j]) std::swap(i, j);
    const double t = height[i] / (height[i] - height[j]);
    intersection.points.push_back(facet.corner[i] + t * (facet.corner[j] - facet.corner[i]));
  });
  return intersection;
}

// Sorts the parameters and joins those closer than `gap`.
void sort_and_join(std::vector<double>& t, double gap) {
  std::sort(t.begin(), t.end());
  t.erase(std::unique(t.begin(), t.end(), [gap](double a, double b) { return b - a <= gap; }),
          t.end());
}

// Returns the parts between neighbouring points that belong to both facets. The points lie on one
// line.
std::vector<ContactSegment> shared_parts(std::vector<Vector3d> points, const FacetPlane& a,
                                         const FacetPlane& b, double tolerance) {
  if (points.size() < 2) return {};
  const auto farthest = [&](const Vector3d& from) {
    constexpr double clearly = 1.0 + 1e-9;  // the first of equals wins, in every unit of length
    Vector3d best = from;
    for (const Vector3d& p : points) {
      if ((p - from).norm() > clearly * (best - from).norm()) best = p;
    }
    return best;
  };
  // The direction between the two ends of the set is well conditioned even for nearly parallel
  // planes.
  const Vector3d low = farthest(points.front());
  const Vector3d high = farthest(low);
  const double length = (high - low).norm();
  if (!(length > tolerance)) return {};
  const Vector3d direction = (high - low) / length;
  const auto parameter = [&](const Vector3d& p) { return direction.dot(p - low); };
  std::sort(points.begin(), points.end(),
            [&](const auto& p, const auto& q) { return parameter(p) < parameter(q); });
  std::vector<ContactSegment> segments;
  Vector3d from = points.front();
  for (const Vector3d& to : points) {
    if (!(parameter(to) - parameter(from) > tolerance)) continue;
    const Vector3d middle = 0.5 * (from + to);
    if (a.contains(a.project(middle), tolerance) && b.contains(b.project(middle), tolerance)) {
      segments.push_back({from, to});
    }
    from = to;
  }
  return segments;
}

// Appends the parts of a segment in the plane of the facet `on` that lie on the facet.
void clip_segment(const Vector3d& start, const Vector3d& end, const FacetPlane& on,
                  double tolerance, std::vector<ContactSegment>& segments) {
  const Vector2d p = on.project(start), d = on.project(end) - p;
  const double length = d.norm();
  if (!(length > tolerance)) return;
  const Vector2d across(-d.y() / length, d.x() / length);
  std::vector<double> t{0.0, 1.0};
  const auto add = [&t](double x) {
    if (x > 0.0 && x < 1.0) t.push_back(x);
  };
  on.for_each_edge([&](int k, int l) {
    double hk = across.dot(on.xy[k] - p), hl = across.dot(on.xy[l] - p);
    if (std::abs(hk) <= tolerance) hk = 0.0;
    if (std::abs(hl) <= tolerance) hl = 0.0;
    if (hk == 0.0) add(d.dot(on.xy[k] - p) / (length * length));
    if (hk * hl < 0.0) {
      const Vector2d x = on.xy[k] + hk / (hk - hl) * (on.xy[l] - on.xy[k]);
      add(d.dot(x - p) / (length * length));
    }
  });
  sort_and_join(t, tolerance / length);
  if (t.back() != 1.0) t.back() = 1.0;  // the edge's end replaces a point joined with it
  for (std::size_t k = 0; k + 1 < t.size(); ++k) {
    if (!on.contains(p + 0.5 * (t[k] + t[k + 1]) * d, tolerance)) continue;
    const auto at = [&](double x) -> Vector3d {
      return x == 0.0 ? start : x == 1.0 ? end : Vector3d(start + x * (end - start));
    };
    segments.push_back({at(t[k]), at(t[k + 1])});
  }
}

int shared_corners(const FacetPlane& a, const FacetPlane& b) {
  int count = 0;
  for (int p : a.point) count += static_cast<int>(std::count(b.point.begin(), b.point.end(), p));
  return count;
}

// True for two triangles of one plane on the two sides of a common edge: neighbours in one mesh.
bool are_flat_neighbours(const FacetPlane& a, const FacetPlane& b, double tolerance) {
  const auto apex = [](const FacetPlane& of, const FacetPlane& other) {
    for (int i = 0; i < 3; ++i) {
      if (std::count(other.point.begin(), other.point.end(), of.point[i]) == 0) return i;
    }
    return 0;
  };
  const int ia = apex(a, b), ib = apex(b, a);
  const Vector2d p = a.xy[(ia + 1) % 3], d = (a.xy[(ia + 2) % 3] - p).normalized();
  const auto side = [&](const Vector2d& q) { return d.x() * (q - p).y() - d.y() * (q - p).x(); };
  return side(a.xy[ia]) > tolerance && side(a.project(b.corner[ib])) < -tolerance;
}

constexpr int least_chords = 12;  // a circle of fewer chords loses more than 5 % of the disk

// Height of points of a frustum over a plane, as a function of longitude and of the place from base
// (0) to top (1), in which it is linear.
struct HeightOnFrustum {
  HeightOnFrustum(const FacetPlane& over, const Frustum& of)
      : plane(over), frustum(of), frame(longitudes(of)) {}

  Vector3d point(double phi, double along) const {
    return frustum.base + along * frustum.height * frustum.axis +
           radius_at(frustum, along) * (std::cos(phi) * frame.zero + std::sin(phi) * frame.quarter);
  }
  double operator()(double phi, double along) const { return plane.height(point(phi, along)); }

  const FacetPlane& plane;
  const Frustum& frustum;
  LongitudeFrame frame;
};

// Longitude at which the height on a rim is 0, between two at which it differs in sign.
double crossing_on_rim(const HeightOnFrustum& height, double from, double to, double along) {
  const bool rises = height(from, along) <= 0.0;
  constexpr int halvings = 50;
  for (int i = 0; i < halvings; ++i) {
    const double middle = 0.5 * (from + to);
    ((height(middle, along) <= 0.0) == rises ? from : to) = middle;
  }
  return 0.5 * (from + to);
}

// The piece of the line of height 0 between two generators, from the heights at the corners of this
// strip. A strip that the line enters by all four sides, which is much wider than a chord of the
// curve, keeps one of the two pieces.
void add_piece(const HeightOnFrustum& height, double from, double to,
               std::vector<ContactSegment>& pieces) {
  std::vector<Vector3d> ends;
  for (const double phi : {from, to}) {
    const double base = height(phi, 0.0), top = height(phi, 1.0);
    if ((base > 0.0) == (top > 0.0)) continue;
    ends.push_back(height.point(phi, std::clamp(base / (base - top), 0.0, 1.0)));
  }
  for (const double along : {0.0, 1.0}) {
    if ((height(from, along) > 0.0) == (height(to, along) > 0.0)) continue;
    ends.push_back(height.point(crossing_on_rim(height, from, to, along), along));
  }
  if (ends.size() >= 2) pieces.push_back({ends[0], ends[1]});
}

std::vector<ContactSegment> contact_of(const FacetPlane& plane, const Frustum& frustum,
                                       double max_arc, double min_radius, double tolerance) {
  const double widest = std::max(frustum.base_radius, frustum.top_radius);
  if (!(widest > min_radius)) return {};
  const HeightOnFrustum height(plane, frustum);
  const double highest = reach(frustum, plane.normal) - plane.normal.dot(plane.origin);
  const double lowest = -reach(frustum, -plane.normal) - plane.normal.dot(plane.origin);
  if (highest < -tolerance || lowest > tolerance) return {};
  // A frustum that stands on the plane touches it with a rim.
  const bool touches = highest <= tolerance || lowest >= -tolerance;
  constexpr double full_turn = 2.0 * std::numbers::pi;
  const int chords = std::max(
      least_chords, static_cast<int>(std::min(1e4, std::ceil(full_turn * widest / max_arc))));
  std::vector<ContactSegment> pieces;
  for (int i = 0; i < chords; ++i) {
    const double from = full_turn * i / chords, to = full_turn * (i + 1) / chords;
    if (!touches) {
      add_piece(height, from, to, pieces);
      continue;
    }
    for (const double along : {0.0, 1.0}) {
      const bool is_on =
          std::abs(height(from, along)) <= tolerance && std::abs(height(to, along)) <= tolerance;
      if (is_on) pieces.push_back({height.point(from, along), height.point(to, along)});
    }
  }
  std::vector<ContactSegment> segments;
  for (const auto& [from, to] : pieces) clip_segment(from, to, plane, tolerance, segments);
  return segments;
}

std::vector<ContactSegment> contact_of(const FacetPlane& plane, const Sphere& sphere,
                                       double max_arc, double min_radius, double tolerance) {
  constexpr double full_turn = 2.0 * std::numbers::pi;
  const double height = plane.height(sphere.center);
  const double squared = sphere.radius * sphere.radius - height * height;
  if (!(squared > min_radius * min_radius)) return {};
  const double radius = std::sqrt(squared);
  const Vector2d center = plane.project(sphere.center);

  // Angles at which the circle crosses the boundary. The points are computed on the edges, so that
  // the facet across an edge finds the same ones.
  std::vector<std::pair<double, Vector3d>> cuts;
  plane.for_each_edge([&](int i, int j) {
    if (plane.point[i] > plane.point[j]) std::swap(i, j);
    const Vector3d d = plane.corner[j] - plane.corner[i], o = plane.corner[i] - sphere.center;
    const double a = d.squaredNorm(), half_b = d.dot(o);
    const double root = half_b * half_b - a * (o.squaredNorm() - sphere.radius * sphere.radius);
    if (!(root > 0.0)) return;
    for (const double sign : {-1.0, 1.0}) {
      const double t = (-half_b + sign * std::sqrt(root)) / a;
      if (!(t >= 0.0 && t <= 1.0)) continue;
      const Vector3d point = plane.corner[i] + t * d;
      const Vector2d q = plane.project(point) - center;
      cuts.emplace_back(std::atan2(q.y(), q.x()), point);
    }
  });
  std::sort(cuts.begin(), cuts.end(),
            [](const auto& p, const auto& q) { return p.first < q.first; });
  const auto on_circle = [&](double angle) {
    return Vector2d(center + radius * Vector2d(std::cos(angle), std::sin(angle)));
  };
  if (cuts.empty()) cuts.emplace_back(0.0, plane.lift(on_circle(0.0)));

  const double max_angle = std::min(max_arc / radius, full_turn / least_chords);
  std::vector<ContactSegment> segments;
  for (std::size_t c = 0; c < cuts.size(); ++c) {
    const bool is_last = c + 1 == cuts.size();
    const double from = cuts[c].first;
    const double to = is_last ? cuts.front().first + full_turn : cuts[c + 1].first;
    if (!((to - from) * radius > tolerance)) continue;
    if (!plane.contains(on_circle(0.5 * (from + to)), 0.0)) continue;
    const int chords = std::max(1, static_cast<int>(std::ceil((to - from) / max_angle)));
    Vector3d previous = cuts[c].second;
    for (int k = 1; k <= chords; ++k) {
      const Vector3d next = k == chords ? cuts[is_last ? 0 : c + 1].second
                                        : plane.lift(on_circle(from + (to - from) * k / chords));
      segments.push_back({previous, next});
      previous = next;
    }
  }
  return segments;
}

}  // namespace

std::vector<ContactSegment> facet_contact(const FacetPlane& a, const FacetPlane& b,
                                          double tolerance) {
  // The tolerance of a large scene may exceed the extent of a small facet, so a share of the extent
  // bounds it.
  constexpr double share_of_extent = 1e-3;
  tolerance = std::min({tolerance, share_of_extent * a.box.diagonal().norm(),
                        share_of_extent * b.box.diagonal().norm()});
  const PlaneIntersection of_b = intersect_plane(b, a, tolerance);
  if (!of_b.can_share) return {};
  const PlaneIntersection of_a = intersect_plane(a, b, tolerance);
  if (!of_a.can_share) return {};
  const bool coplanar = of_a.in_plane || of_b.in_plane;
  const bool neighbours = a.is_triangle() && b.is_triangle() && shared_corners(a, b) == 2;
  if (neighbours && (!coplanar || are_flat_neighbours(a, b, tolerance))) return {};
  if (!coplanar) {
    std::vector<Vector3d> points = of_a.points;
    points.insert(points.end(), of_b.points.begin(), of_b.points.end());
    return shared_parts(std::move(points), a, b, tolerance);
  }
  std::vector<ContactSegment> segments;
  b.for_each_edge(
      [&](int i, int j) { clip_segment(b.corner[i], b.corner[j], a, tolerance, segments); });
  a.for_each_edge(
      [&](int i, int j) { clip_segment(a.corner[i], a.corner[j], b, tolerance, segments); });
  return segments;
}

std::vector<ContactSegment> round_contact(const FacetPlane& plane, const RoundShape& shape,
                                          double max_arc, double min_radius, double tolerance) {
  return std::visit(
      [&](const auto& s) { return contact_of(plane, s, max_arc, min_radius, tolerance); }, shape);
}

}  // namespace lightwell
