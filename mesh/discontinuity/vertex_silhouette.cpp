#include "mesh/discontinuity/vertex_silhouette.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace lightwell {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

using std::numbers::pi;
constexpr double same_angle = 1e-7;  // radians: sectors that share an edge touch to within rounding

// Angles hidden around a point, as ranges within [0, 2 pi).
class HiddenAngles {
 public:
  // Adds the range of `length` radians that begins at `start`, counter-clockwise.
  void add(double start, double length) {
    if (start < 0.0) start += 2.0 * pi;
    ranges_.push_back({start, std::min(start + length, 2.0 * pi)});
    if (start + length > 2.0 * pi) ranges_.push_back({0.0, start + length - 2.0 * pi});
  }
  void join() {
    std::sort(ranges_.begin(), ranges_.end());
    std::vector<std::array<double, 2>> joined;
    for (const auto& r : ranges_) {
      if (joined.empty() || r[0] > joined.back()[1] + same_angle) {
        joined.push_back(r);
      } else {
        joined.back()[1] = std::max(joined.back()[1], r[1]);
      }
    }
    ranges_ = std::move(joined);
  }
  bool hides(double from, double to) const {
    return std::any_of(ranges_.begin(), ranges_.end(), [&](const auto& r) {
      return r[0] <= from + same_angle && r[1] >= to - same_angle;
    });
  }
  // True if exactly one half turn is hidden, at any position: the point lies in the middle of a
  // straight edge.
  bool is_half() const {
    if (ranges_.empty()) return false;
    double total = 0.0;
    for (const auto& r : ranges_) total += r[1] - r[0];
    const bool wraps = ranges_.size() == 2 && ranges_.front()[0] <= same_angle &&
                       ranges_.back()[1] >= 2.0 * pi - same_angle;
    return std::abs(total - pi) <= same_angle && (ranges_.size() == 1 || wraps);
  }

 private:
  std::vector<std::array<double, 2>> ranges_{};
};

}  // namespace

void add_sectors(const FacetPlane& plane, const Vector3d& p, double tolerance,
                 std::vector<FacetSector>& sectors) {
  if (!(std::abs(plane.height(p)) <= tolerance)) return;
  const Vector2d q = plane.project(p);
  bool at_corner = false, on_edge = false;
  const auto is_at = [&](int i) { return (plane.xy[i] - q).norm() <= tolerance; };
  for (int l = 0; l < plane.loop_count(); ++l) {
    const int begin = plane.loop_begin[l], end = plane.loop_begin[l + 1];
    for (int i = begin; i < end; ++i) {
      if (!is_at(i)) continue;
      at_corner = true;
      const int next = i + 1 < end ? i + 1 : begin, previous = i > begin ? i - 1 : end - 1;
      sectors.push_back({plane.normal, (plane.corner[next] - plane.corner[i]).normalized(),
                         (plane.corner[previous] - plane.corner[i]).normalized()});
    }
  }
  if (at_corner) return;
  plane.for_each_edge([&](int i, int j) {
    if (on_edge || !(segment_distance(q, plane.xy[i], plane.xy[j]) <= tolerance)) return;
    on_edge = true;
    const Vector3d d = (plane.corner[j] - plane.corner[i]).normalized();
    sectors.push_back({plane.normal, d, -d});
  });
  if (on_edge || !plane.contains(q, 0.0)) return;
  sectors.push_back({plane.normal, plane.axis_x, plane.axis_x, true});
}

std::vector<WedgeRange> silhouette_ranges(const Wedge& wedge,
                                          const std::vector<FacetSector>& sectors) {
  // The side of a facet that faces a ray changes where the ray lies in the facet's plane.
  std::vector<double> stops{0.0, 1.0};
  for (const FacetSector& sector : sectors) {
    const double at = sector.normal.dot(wedge.along), by = sector.normal.dot(wedge.across);
    const double s = -at / by;
    if (s > 0.0 && s < 1.0) stops.push_back(s);
  }
  std::sort(stops.begin(), stops.end());
  std::vector<WedgeRange> ranges;
  for (std::size_t k = 0; k + 1 < stops.size(); ++k) {
    constexpr double least_range = 1e-10;
    if (!(stops[k + 1] - stops[k] > least_range)) continue;
    const Vector3d d = wedge.direction(0.5 * (stops[k] + stops[k + 1])).normalized();
    // A frame for the view along d: x points to the right, y to the front of the wedge.
    const Vector3d y = wedge.normal, x = d.cross(y);
    HiddenAngles hidden;
    for (const FacetSector& sector : sectors) {
      const double facing = sector.normal.dot(d);
      constexpr double edge_on = 1e-9;
      if (!(std::abs(facing) > edge_on)) continue;
      if (sector.is_full) {
        hidden.add(0.0, 2.0 * pi);
        continue;
      }
      // (x, y, -d) is right-handed, so a sector about a normal that faces against d is
      // counter-clockwise in (x, y) as well. The ends of any other sector change places.
      const Vector3d& from = facing < 0.0 ? sector.from : sector.to;
      const Vector3d& to = facing < 0.0 ? sector.to : sector.from;
      const double start = std::atan2(from.dot(y), from.dot(x));
      double length = std::atan2(to.dot(y), to.dot(x)) - start;
      if (length <= 0.0) length += 2.0 * pi;
      hidden.add(start, length);
    }
    hidden.join();
    if (hidden.hides(0.0, 2.0 * pi) || hidden.is_half()) continue;
    const unsigned front = hidden.hides(0.0, pi) ? hides_front : hides_nothing;
    const unsigned back = hidden.hides(pi, 2.0 * pi) ? hides_back : hides_nothing;
    if ((front | back) != hides_both) ranges.push_back({stops[k], stops[k + 1], front | back});
  }
  return ranges;
}

}  // namespace lightwell
