// The part of ContactGraph that cuts lines where they cross, and at points on them.
#include <algorithm>
#include <cmath>
#include <limits>

#include "mesh/contacts/contact_effort.h"
#include "mesh/contacts/contact_graph.h"
#include "mesh/geometry/box_tree.h"
#include "scene/parallel.h"

namespace lightwell {
namespace {

using Eigen::Vector3d;

BoxTree::Box segment_box(const Vector3d& a, const Vector3d& b, double by) {
  const Vector3d d = Vector3d::Constant(by);
  return {a.cwiseMin(b) - d, a.cwiseMax(b) + d};
}

// Computes the parameters of the closest points of the lines p + s u and q + t v; false if the
// lines are parallel.
bool closest_parameters(const Vector3d& p, const Vector3d& u, const Vector3d& q, const Vector3d& v,
                        double& s, double& t) {
  const double uu = u.squaredNorm(), uv = u.dot(v), vv = v.squaredNorm();
  const double determinant = u.cross(v).squaredNorm();
  // Smallest sin^2 of the angle. The ends of a common part are found by cut_at_points.
  constexpr double parallel = 1e-12;
  if (!(determinant > parallel * uu * vv)) return false;
  const Vector3d w = q - p;
  s = (vv * u.dot(w) - uv * v.dot(w)) / determinant;
  t = (uv * u.dot(w) - uu * v.dot(w)) / determinant;
  return true;
}

}  // namespace

struct ContactGraph::Crossing {
  int other = 0;
  double s = 0.0, t = 0.0;  // parameters on the segment and on the other
  Vector3d point = Vector3d::Zero();
};

std::vector<ContactGraph::Crossing> ContactGraph::crossings_of(
    int segment, const std::vector<int>& others) const {
  const double tolerance = welded_.tolerance();
  const Segment& si = segments_[segment];
  const Vector3d p = welded_[si.a], u = welded_[si.b] - p;
  std::vector<Crossing> crossings;
  for (auto next = std::ranges::upper_bound(others, segment); next != others.end(); ++next) {
    const int j = *next;
    const Segment& sj = segments_[j];
    if (si.a == sj.a || si.a == sj.b || si.b == sj.a || si.b == sj.b) continue;
    const Vector3d q = welded_[sj.a], v = welded_[sj.b] - q;
    double s, t;
    if (!closest_parameters(p, u, q, v, s, t)) continue;
    // A crossing near an end is that end, which cut_at_points finds.
    const double end_s = tolerance / u.norm(), end_t = tolerance / v.norm();
    if (!(s > end_s && s < 1.0 - end_s && t > end_t && t < 1.0 - end_t)) continue;
    const Vector3d on_i = p + s * u, on_j = q + t * v;
    if ((on_i - on_j).norm() <= tolerance) crossings.push_back({j, s, t, 0.5 * (on_i + on_j)});
  }
  return crossings;
}

// Crossings of the lines of one facet alone. Where lines were left out, others that lie in the same
// place would be cut by lines that are not theirs.
std::vector<std::vector<ContactGraph::Crossing>> ContactGraph::crossings_within_facets() const {
  const int count = static_cast<int>(planes_.size());
  std::vector<std::vector<std::vector<Crossing>>> of_facet(planes_.size());
  const auto lines_of = [&](int i) {
    std::vector<int> lines;
    for (int e = 0; e < planes_[i].corner_count(); ++e) {
      lines.push_back(edge_segment_[first_edge_[i] + e]);
    }
    for (const auto* more : {&contact_segments_[i], &crease_segments_[i]}) {
      lines.insert(lines.end(), more->begin(), more->end());
    }
    std::sort(lines.begin(), lines.end());
    lines.erase(std::unique(lines.begin(), lines.end()), lines.end());
    return lines;
  };
  parallel_for(count, 32, [&](int begin, int end) {
    for (int i = begin; i < end; ++i) {
      const std::vector<int> lines = lines_of(i);
      for (const int line : lines) of_facet[i].push_back(crossings_of(line, lines));
    }
  });
  std::vector<std::vector<Crossing>> crossings(segments_.size());
  for (int i = 0; i < count; ++i) {
    const std::vector<int> lines = lines_of(i);
    for (std::size_t l = 0; l < lines.size(); ++l) {
      auto& all = crossings[lines[l]];
      all.insert(all.end(), of_facet[i][l].begin(), of_facet[i][l].end());
    }
  }
  return crossings;
}

std::vector<std::vector<ContactGraph::Crossing>> ContactGraph::all_crossings(
    ContactEffort& effort) const {
  const double tolerance = welded_.tolerance();
  const int count = static_cast<int>(segments_.size());
  std::vector<BoxTree::Box> boxes(count);
  for (int i = 0; i < count; ++i) {
    boxes[i] = segment_box(welded_[segments_[i].a], welded_[segments_[i].b], tolerance);
  }
  const BoxTree tree(boxes);
  std::vector<std::vector<Crossing>> crossings(count);
  parallel_for(count, 64, [&](int begin, int end) {
    std::vector<int> near;
    for (int i = begin; i < end && !effort.is_exceeded(); ++i) {
      tree.find_overlaps_from(i + 1, boxes[i], near);
      effort.count(1 + 2 * near.size());  // each is near itself, and two are near each other
      crossings[i] = crossings_of(i, near);
      effort.found(crossings[i].size());
    }
  });
  return crossings;
}

void ContactGraph::cut_at_crossings() {
  std::vector<std::vector<Crossing>> crossings;
  ContactEffort effort(static_cast<int>(planes_.size()));
  const bool is_whole = std::ranges::find(lacks_contacts_, 1) == lacks_contacts_.end();
  if (is_whole) crossings = all_crossings(effort);
  if (!is_whole || effort.is_exceeded()) crossings = crossings_within_facets();
  for (int i = 0; i < static_cast<int>(segments_.size()); ++i) {
    for (const Crossing& crossing : crossings[i]) {
      const int point = welded_.add(crossing.point, welded_.tolerance());
      cuts_[i].emplace_back(crossing.s, point);
      cuts_[crossing.other].emplace_back(crossing.t, point);
    }
  }
}

void ContactGraph::cut_at_points() {
  std::vector<BoxTree::Box> boxes;
  for (const Vector3d& p : welded_.all()) boxes.emplace_back(p, p);
  const BoxTree tree(std::move(boxes));
  parallel_for(static_cast<int>(segments_.size()), 64, [&](int begin, int end) {
    std::vector<int> near;
    for (int i = begin; i < end; ++i) {
      const Segment& s = segments_[i];
      const Vector3d p = welded_[s.a], d = welded_[s.b] - p;
      const double length = d.norm();
      constexpr double share_of_length = 1e-3;
      const double tolerance = std::min(welded_.tolerance(), share_of_length * length);
      std::int64_t visits = std::numeric_limits<std::int64_t>::max();
      tree.find_along(p, welded_[s.b], tolerance, visits, near);
      for (int point : near) {
        if (point == s.a || point == s.b) continue;
        // A needle's apex may lie on its own long edge; a cut there would fold the triangle up.
        if (point == s.triangle_apex[0] || point == s.triangle_apex[1]) continue;
        const double t = d.dot(welded_[point] - p) / (length * length);
        if (!(t * length > tolerance && (1.0 - t) * length > tolerance)) continue;
        if ((welded_[point] - p - t * d).norm() <= tolerance) cuts_[i].emplace_back(t, point);
      }
      std::sort(cuts_[i].begin(), cuts_[i].end());
    }
  });
}

}  // namespace lightwell
