#include "mesh/discontinuity/wedge.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace lightwell {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

// In s; shorter ranges of rays come from rounding.
constexpr double least_range = 1e-10;

// Coordinates (alpha, beta) of a point apex + alpha along + beta across of the wedge's plane.
class WedgeFrame {
 public:
  explicit WedgeFrame(const Wedge& wedge) : apex_(wedge.apex) {
    const Vector3d a = wedge.across.cross(wedge.normal), b = wedge.normal.cross(wedge.along);
    dual_along_ = a / a.dot(wedge.along);
    dual_across_ = b / b.dot(wedge.across);
  }
  Vector2d place(const Vector3d& p) const {
    return {dual_along_.dot(p - apex_), dual_across_.dot(p - apex_)};
  }

 private:
  Vector3d apex_, dual_along_, dual_across_;
};

struct PlaneSegment {
  Vector3d from, to;
  unsigned mask;
};

// Finds the segments in which a facet meets the wedge's plane. `height` is scratch memory.
void meet_facet(const FacetPlane& facet, const Wedge& wedge, double tolerance,
                std::vector<double>& height, std::vector<PlaneSegment>& segments) {
  segments.clear();
  height.resize(facet.corner.size());
  int above = 0, below = 0, on = 0;
  for (std::size_t i = 0; i < height.size(); ++i) {
    height[i] = wedge.normal.dot(facet.corner[i] - wedge.apex);
    if (std::abs(height[i]) <= tolerance) height[i] = 0.0;
    (height[i] > 0.0 ? above : height[i] < 0.0 ? below : on)++;
  }
  if (above == 0 && below == 0) return;
  if ((above == 0 || below == 0) && on < 2) return;
  struct Intersection {
    double along;
    Vector3d point;
    int corner;
  };
  const Vector3d line = facet.normal.cross(wedge.normal);
  std::vector<Intersection> intersections;
  facet.for_each_edge([&](int i, int j) {
    if (height[i] == 0.0) intersections.push_back({line.dot(facet.corner[i]), facet.corner[i], i});
    if (!(height[i] * height[j] < 0.0)) return;
    // Interpolated from the lower-numbered end, so that both facets of an edge get the same bits.
    if (facet.point[i] > facet.point[j]) std::swap(i, j);
    const double t = height[i] / (height[i] - height[j]);
    const Vector3d point = facet.corner[i] + t * (facet.corner[j] - facet.corner[i]);
    intersections.push_back({line.dot(point), point, -1});
  });
  std::sort(intersections.begin(), intersections.end(),
            [](const Intersection& a, const Intersection& b) { return a.along < b.along; });
  const auto edge_mask = [&](int one, int other) -> unsigned {
    unsigned mask = hides_nothing;
    if (one < 0 || other < 0) return mask;
    facet.for_each_edge([&](int i, int j) {
      if (!((i == one && j == other) || (i == other && j == one))) return;
      const Vector3d inwards = facet.normal.cross(facet.corner[j] - facet.corner[i]);
      mask |= inwards.dot(wedge.normal) > 0.0 ? hides_front : hides_back;
    });
    return mask;
  };
  for (std::size_t k = 0; k + 1 < intersections.size(); ++k) {
    const Intersection &a = intersections[k], &b = intersections[k + 1];
    if (!((b.point - a.point).norm() > tolerance)) continue;
    unsigned mask = edge_mask(a.corner, b.corner);
    if (mask == hides_nothing && facet.contains(facet.project(0.5 * (a.point + b.point)), 0.0)) {
      mask = hides_both;
    }
    if (mask != hides_nothing) segments.push_back({a.point, b.point, mask});
  }
}

// Position of a cut along the rays.
enum class Phase { before, contact, beyond };  // relative to the occluder

// A cut of a facet through the rays begin..end of a wedge, with 1/|alpha| linear in s; or an edge
// that the rays touch, with its facet on one side.
struct Cut {
  int facet = 0;
  unsigned mask = hides_both;
  Phase phase = Phase::beyond;
  double begin = 0.0, end = 0.0;
  double w_begin = 0.0, w_end = 0.0;  // 1/|alpha|

  double w(double s) const { return w_begin + (w_end - w_begin) * (s - begin) / (end - begin); }
};

// Clips a segment to the rays between 0 and 1, beyond the apex (sign 1) or before the apex (sign
// -1). Returns false if nothing is left.
bool clip_to_rays(Vector2d a, Vector2d b, double sign, double least_alpha, Cut& cut) {
  a *= sign;
  b *= sign;
  double from = 0.0, to = 1.0;
  const auto clip = [&](double fa, double fb) {  // keeps the part at which the value is >= 0
    if (fa < 0.0 && fb < 0.0) to = -1.0;
    if (fa < 0.0 && fb >= 0.0) from = std::max(from, fa / (fa - fb));
    if (fa >= 0.0 && fb < 0.0) to = std::min(to, fa / (fa - fb));
  };
  clip(a.x() - least_alpha, b.x() - least_alpha);
  clip(a.y(), b.y());
  clip(a.x() - a.y(), b.x() - b.y());
  if (!(from < to)) return false;
  const Vector2d p = a + from * (b - a), q = a + to * (b - a);
  const double s = std::clamp(p.y() / p.x(), 0.0, 1.0), t = std::clamp(q.y() / q.x(), 0.0, 1.0);
  if (!(std::abs(s - t) > least_range)) return false;
  const bool forward = s < t;
  cut.begin = forward ? s : t;
  cut.end = forward ? t : s;
  cut.w_begin = 1.0 / (forward ? p : q).x();
  cut.w_end = 1.0 / (forward ? q : p).x();
  return true;
}

// Adds a cut with its phase. |alpha| = 1 is the occluder's edge in a VE wedge and the emitter's
// edge in an EV wedge; a cut that crosses |alpha| = 1 is split into two there.
void add_cut(const Wedge& wedge, Cut cut, double sign, double slack, std::vector<Cut>& cuts) {
  const double at_begin = cut.w_begin - 1.0, at_end = cut.w_end - 1.0;
  const bool is_near = std::max(at_begin, at_end) > slack;  // partly at |alpha| < 1
  const bool is_far = std::min(at_begin, at_end) < -slack;
  if (!wedge.is_vertex_edge) {
    cut.phase = sign > 0.0 ? Phase::beyond : Phase::before;
    if (sign > 0.0 || (is_near && !is_far)) cuts.push_back(cut);
    if (sign > 0.0 || !is_near || !is_far) return;
  } else if (!is_near || !is_far) {
    cut.phase = is_near ? Phase::before : is_far ? Phase::beyond : Phase::contact;
    cuts.push_back(cut);
    return;
  }
  const double s = cut.begin + (cut.end - cut.begin) * at_begin / (at_begin - at_end);
  Cut first = cut, second = cut;
  first.end = second.begin = s;
  first.w_end = second.w_begin = 1.0;
  first.phase = at_begin > 0.0 ? Phase::before : Phase::beyond;
  second.phase = at_begin > 0.0 ? Phase::beyond : Phase::before;
  for (const Cut& part : {first, second}) {
    if (!(part.end - part.begin > least_range)) continue;
    if (part.phase == Phase::before || wedge.is_vertex_edge) cuts.push_back(part);
  }
}

std::vector<Cut> cuts_of(const Wedge& wedge, const std::vector<FacetPlane>& planes,
                         const std::vector<int>& near, double tolerance) {
  const WedgeFrame frame(wedge);
  // The tolerance as a share of the shorter one of the two outer rays.
  const double slack = tolerance / std::min(wedge.along.norm(), wedge.direction(1.0).norm());
  std::vector<Cut> cuts;
  std::vector<double> height;
  std::vector<PlaneSegment> segments;
  for (const int facet : near) {
    meet_facet(planes[facet], wedge, tolerance, height, segments);
    for (const PlaneSegment& segment : segments) {
      // A segment through the apex hides a single ray.
      const Vector3d d = (segment.to - segment.from).normalized();
      if (!((segment.from - wedge.apex).cross(d).norm() > tolerance)) continue;
      const Vector2d a = frame.place(segment.from), b = frame.place(segment.to);
      Cut cut{.facet = facet, .mask = segment.mask};
      if (clip_to_rays(a, b, 1.0, slack, cut)) add_cut(wedge, cut, 1.0, slack, cuts);
      if (wedge.is_vertex_edge) continue;
      if (clip_to_rays(a, b, -1.0, slack, cut)) add_cut(wedge, cut, -1.0, slack, cuts);
    }
  }
  std::stable_sort(cuts.begin(), cuts.end(),
                   [](const Cut& a, const Cut& b) { return a.begin < b.begin; });
  return cuts;
}

// Sweeps over the rays from s = 0 to s = 1 and finds what each ray meets.
class RaySweep {
 public:
  RaySweep(const Wedge& wedge, std::vector<Cut> cuts) : wedge_(wedge), cuts_(std::move(cuts)) {}

  std::vector<WedgeTrace> run(const std::vector<WedgeRange>& ranges) {
    std::vector<double> stops;
    for (const Cut& c : cuts_) stops.insert(stops.end(), {c.begin, c.end});
    for (const WedgeRange& r : ranges) stops.insert(stops.end(), {r.begin, r.end});
    std::sort(stops.begin(), stops.end());
    std::size_t next = 0;
    for (std::size_t k = 0; k + 1 < stops.size(); ++k) {
      if (!(stops[k + 1] - stops[k] > 0.0)) continue;
      const double middle = 0.5 * (stops[k] + stops[k + 1]);
      for (; next < cuts_.size() && cuts_[next].begin < middle; ++next) {
        open_.push_back(static_cast<int>(next));
      }
      std::erase_if(open_, [&](int i) { return cuts_[i].end < middle; });
      for (const WedgeRange& r : ranges) {
        if (r.begin < middle && middle < r.end) follow(stops[k], stops[k + 1], r.mask, 0);
      }
    }
    std::erase_if(traces_, [](const WedgeTrace& t) { return !(t.end - t.begin > least_range); });
    return std::move(traces_);
  }

 private:
  // Handles the rays between two neighbouring stops. `own` is the mask of the occluder's own faces.
  void follow(double begin, double end, unsigned own, int depth) {
    const double middle = 0.5 * (begin + end);
    unsigned mask = own;
    const Cut* receiver = nullptr;
    std::vector<const Cut*> beyond;
    for (const int i : open_) {
      const Cut& c = cuts_[i];
      if (c.phase == Phase::beyond)
        beyond.push_back(&c);
      else if (c.phase == Phase::contact && c.mask == hides_both)
        receiver = &c;
      else
        mask |= c.mask;
    }
    if (mask == hides_both) return;
    if (receiver) {
      add(*receiver, begin, end, true);
      return;
    }
    std::sort(beyond.begin(), beyond.end(), [middle](const Cut* a, const Cut* b) {
      const double wa = a->w(middle), wb = b->w(middle);
      return wa != wb ? wa > wb : a->facet < b->facet;
    });
    for (const Cut* c : beyond) {
      mask |= c->mask;
      if (c->mask == hides_both) receiver = c;
      if (mask == hides_both) break;
    }
    if (!receiver) return;
    // Facets that cross each other in the plane change their order along the rays; the range is
    // split at the crossing.
    constexpr int deepest = 24;
    for (const Cut* c : beyond) {
      if (c == receiver || depth >= deepest) continue;
      const double d0 = c->w(begin) - receiver->w(begin), d1 = c->w(end) - receiver->w(end);
      const double rounding = 1e-9 * (std::abs(receiver->w(begin)) + std::abs(receiver->w(end)));
      if (!(std::min(d0, d1) < -rounding && std::max(d0, d1) > rounding)) continue;
      const double s = begin + (end - begin) * d0 / (d0 - d1);
      if (!(s - begin > least_range && end - s > least_range)) continue;
      follow(begin, s, own, depth + 1);
      follow(s, end, own, depth + 1);
      return;
    }
    add(*receiver, begin, end, false);
  }

  void add(const Cut& cut, double begin, double end, bool is_contact) {
    const auto at = [&](double s) { return wedge_.at(s, is_contact ? 1.0 : 1.0 / cut.w(s)); };
    if (last_ == &cut && traces_.back().end == begin) {
      traces_.back().end = end;
      traces_.back().to = at(end);
      return;
    }
    traces_.push_back({cut.facet, begin, end, at(begin), at(end), is_contact});
    last_ = &cut;
  }

  const Wedge& wedge_;
  std::vector<Cut> cuts_;  // by rising `begin`
  std::vector<int> open_{};
  std::vector<WedgeTrace> traces_{};
  const Cut* last_ = nullptr;
};

}  // namespace

Wedge vertex_edge_wedge(const Vector3d& v, const Vector3d& p, const Vector3d& q) {
  const Vector3d along = p - v, across = q - p;
  return {v, along, across, along.cross(across).normalized(), true};
}

Wedge edge_vertex_wedge(const Vector3d& a, const Vector3d& b, const Vector3d& p) {
  const Vector3d along = p - a, across = a - b;
  return {p, along, across, along.cross(across).normalized(), false};
}

std::vector<WedgeTrace> trace_wedge(const Wedge& wedge, const std::vector<WedgeRange>& ranges,
                                    const std::vector<FacetPlane>& planes,
                                    const std::vector<int>& near, double tolerance) {
  return RaySweep(wedge, cuts_of(wedge, planes, near, tolerance)).run(ranges);
}

}  // namespace lightwell
