#include "radiosity/visibility/shadowed_polygon.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>

#include "radiosity/closed_forms/polygon_form_factor.h"

namespace lightwell {
namespace {

using Eigen::Vector3d;

constexpr double flat_sine = 1e-12;   // sine of an angle that counts as 0
constexpr double same = 1.0 - 1e-14;  // cosine of an angle that counts as 0

// Two convex sets to be separated by planes that have some of `points` at heights < 0.
struct Parting {
  std::span<const Vector3d> before, behind;  // at heights >= 0 and <= 0
  std::span<const Vector3d> points;
  double slack;  // m, tolerance of heights
};

// Adds the separating planes through an edge of `edges` and one of `corners`.
void add_parting_planes(const Parting& parting, std::span<const Vector3d> edges,
                        std::span<const Vector3d> corners, std::vector<HalfSpace>& planes) {
  const double slack = parting.slack;
  for (std::size_t k = 0; k < edges.size(); ++k) {
    const Vector3d edge = edges[(k + 1) % edges.size()] - edges[k];
    for (const Vector3d& corner : corners) {
      const Vector3d across = edge.cross(corner - edges[k]);
      const double length = across.norm();
      if (!(length > flat_sine * edge.norm() * (corner - edges[k]).norm())) continue;
      for (const double sign : {1.0, -1.0}) {
        HalfSpace plane{sign / length * across, 0.0};
        plane.offset = plane.normal.dot(edges[k]);
        const bool parts = any_below(parting.points, plane, 0.0) &&
                           !any_below(parting.before, plane, -slack) &&
                           !any_above(parting.behind, plane, slack) &&
                           std::none_of(planes.begin(), planes.end(), [&](const HalfSpace& known) {
                             return known.normal.dot(plane.normal) > same &&
                                    std::abs(known.offset - plane.offset) < slack;
                           });
        if (parts) planes.push_back(plane);
      }
    }
  }
}

// Clips the occluder to the half-spaces of both ends and makes it clockwise seen from the points.
bool cut_to_ends(const Occluder& occluder, int side, const HalfSpace& from, const HalfSpace& target,
                 Blocker& blocker) {
  blocker.polygon = occluder.polygon;
  blocker.plane = {side * occluder.plane.normal, side * occluder.plane.offset};
  blocker.cuts_target = false;
  blocker.reach.clear();
  if (!clip(blocker.polygon, from) || !clip(blocker.polygon, target)) return false;
  if (side > 0) {
    std::reverse(blocker.polygon.corner.begin(),
                 blocker.polygon.corner.begin() + blocker.polygon.count);
  }
  return true;
}

}  // namespace

bool make_point_blocker(const Occluder& occluder, int side, const HalfSpace& from,
                        const HalfSpace& target, std::span<const Vector3d> corners,
                        double tolerance, Blocker& blocker) {
  if (!cut_to_ends(occluder, side, from, target, blocker)) return false;
  if (!any_below(corners, blocker.plane, -tolerance)) return false;
  blocker.cuts_target = any_above(corners, blocker.plane, 0.0);
  return true;
}

bool make_blocker(const Occluder& occluder, int side, const ShaftEnd& from, const ShaftEnd& target,
                  double tolerance, Blocker& blocker) {
  if (!cut_to_ends(occluder, side, from.plane, target.plane, blocker)) return false;
  if (!any_above(from.corners, blocker.plane, tolerance)) return false;
  const HalfSpace beyond = blocker.plane.opposite();
  std::vector<ConvexPolygon> far_parts;
  std::vector<Vector3d> far_corners;
  for (const ConvexPolygon& part : target.parts) {
    ConvexPolygon far_part = part;
    if (!any_above(part.corners(), beyond, tolerance) || !clip(far_part, beyond)) continue;
    far_parts.push_back(far_part);
    far_corners.insert(far_corners.end(), far_part.corners().begin(), far_part.corners().end());
  }
  if (far_parts.empty()) return false;
  blocker.cuts_target = any_above(target.corners, blocker.plane, 0.0);
  const double slack =
      flat_sine * (target.box.merged(from.box).merged(occluder.box)).diagonal().norm();
  const auto near = blocker.polygon.corners();
  blocker.reach.push_back(blocker.plane);
  if (from.parts.empty()) return true;  // a single point has no penumbra
  const Parting parting{near, far_corners, from.corners, slack};
  add_parting_planes(parting, near, far_corners, blocker.reach);
  for (const ConvexPolygon& part : far_parts) {
    add_parting_planes(parting, part.corners(), near, blocker.reach);
  }
  return true;
}

bool clip_to_reach(ConvexPolygon& polygon, const Blocker& blocker) {
  for (const HalfSpace& bound : blocker.reach) {
    if (polygon.count >= ConvexPolygon::most_corners) return true;
    if (!clip(polygon, bound)) return false;
  }
  return true;
}

double ShadowedPolygon::take_away(const Blocker& blocker, const Vector3d& point,
                                  const Vector3d& normal) {
  std::array<HalfSpace, ConvexPolygon::most_corners + 1> pyramid;
  int planes = 0;
  if (blocker.cuts_target) pyramid[planes++] = blocker.plane.opposite();
  const ConvexPolygon& polygon = blocker.polygon;
  for (int k = 0; k < polygon.count; ++k) {
    const Vector3d a = polygon.corner[k] - point;
    const Vector3d b = polygon.corner[k + 1 < polygon.count ? k + 1 : 0] - point;
    // Corners run clockwise, so the normal points into the pyramid.
    const Vector3d across = a.cross(b);
    if (!(across.squaredNorm() > flat_sine * flat_sine * a.squaredNorm() * b.squaredNorm()))
      continue;
    pyramid[planes++] = {across, across.dot(point)};
  }
  double hidden = 0.0;
  left_.clear();
  ConvexPolygon rest, inside, outside;
  for (const ConvexPolygon& fragment : fragments_) {
    const bool is_missed =
        std::any_of(pyramid.begin(), pyramid.begin() + planes, [&](const HalfSpace& plane) {
          const auto corners = fragment.corners();
          return std::none_of(corners.begin(), corners.end(),
                              [&](const Vector3d& p) { return plane.height(p) > 0.0; });
        });
    if (is_missed) {
      left_.push_back(fragment);
      continue;
    }
    // A fragment is split only if some of it is hidden, which saves fragments.
    rest = fragment;
    bool is_any_hidden = true;
    for (int k = 0; k < planes && is_any_hidden; ++k) {
      // A polygon of most_corners corners is not clipped: its hidden part counts as visible.
      is_any_hidden = rest.count < ConvexPolygon::most_corners && clip(rest, pyramid[k]);
    }
    if (!is_any_hidden) {
      left_.push_back(fragment);
      continue;
    }
    hidden += point_to_polygon(point, normal, rest.corners());
    rest = fragment;
    for (int k = 0; k < planes; ++k) {
      if (split(rest, pyramid[k], inside, outside) != Cut::both) continue;
      left_.push_back(outside);
      rest = inside;
    }
  }
  fragments_.swap(left_);
  return hidden;
}

ShadowedPolygon::View ShadowedPolygon::view_from(const Vector3d& point, const Vector3d& normal) {
  View view;
  for (const ConvexPolygon& part : parts_) {
    view.all += point_to_polygon(point, normal, part.corners());
  }
  view.all = std::clamp(view.all, 0.0, 1.0);
  for (std::size_t k = 0; k < blockers_.size(); ++k) {
    if (blockers_[k].reaches(point)) view.met |= std::uint32_t{1} << k;
  }
  if (view.met == 0) return view;
  fragments_.assign(parts_.begin(), parts_.end());
  for (std::size_t k = 0; k < blockers_.size() && !fragments_.empty(); ++k) {
    if ((view.met >> k & 1u) != 0) view.hidden += take_away(blockers_[k], point, normal);
  }
  view.hidden = fragments_.empty() ? view.all : std::clamp(view.hidden, 0.0, view.all);
  view.is_whole = fragments_.empty() || !(view.hidden > 0.0);
  return view;
}

}  // namespace lightwell
