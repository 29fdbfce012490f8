#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "radiosity/visibility/shaft.h"

namespace lightwell {

/// An occluder as seen from points on one side of its plane, clipped to the part that may hide some
/// of a target.
struct Blocker {
  ConvexPolygon polygon{};   ///< clockwise seen from the points
  HalfSpace plane{};         ///< plane of the polygon; the points are at height > 0
  bool cuts_target = false;  ///< some of the target lies on the points' side too
  /// Points outside any of these half-spaces see all of the target past the blocker.
  std::vector<HalfSpace> reach{};

  bool reaches(const Eigen::Vector3d& point) const {
    for (const HalfSpace& bound : reach) {
      if (!(bound.height(point) > 0.0)) return false;
    }
    return true;
  }
};

/// Fills `blocker` with the occluder as seen from the points before (`side` 1) or behind (-1) the
/// occluder's plane. Returns false if the occluder hides nothing of `target` from any point of
/// `from` on that side. `reach` is bounded by the outside of the penumbra: planes through an edge
/// of one and a corner of the other that separate occluder and target.
bool make_blocker(const Occluder& occluder, int side, const ShaftEnd& from, const ShaftEnd& target,
                  double tolerance, Blocker& blocker);

/// Makes a blocker like make_blocker, for a single point at a known side of the occluder's plane,
/// and without `reach`. `from` and `target`: half-spaces that the point and the target can see.
/// `corners`: all corners of the target.
bool make_point_blocker(const Occluder& occluder, int side, const HalfSpace& from,
                        const HalfSpace& target, std::span<const Eigen::Vector3d> corners,
                        double tolerance, Blocker& blocker);

/// Clips the polygon to the reach of the blocker. Returns false if nothing is left. A polygon that
/// grows to most_corners corners is not clipped further.
bool clip_to_reach(ConvexPolygon& polygon, const Blocker& blocker);

/// A polygon behind occluders. The part of the polygon that a convex occluder hides from a point
/// lies in the pyramid from the point over the occluder's edges. Several occluders hide the union
/// of such parts; each part is subtracted from what is left, so no area counts twice.
class ShadowedPolygon {
 public:
  static constexpr int most_blockers = 32;

  ShadowedPolygon() = default;  ///< empty until set()
  /// `parts` tile the polygon, counter-clockwise seen from the points. Keeps references to
  /// parts and blockers.
  ShadowedPolygon(std::span<const ConvexPolygon> parts, std::span<const Blocker> blockers)
      : parts_(parts), blockers_(blockers) {}
  /// Replaces polygon and blockers, reusing memory.
  void set(std::span<const ConvexPolygon> parts, std::span<const Blocker> blockers) {
    parts_ = parts;
    blockers_ = blockers;
  }

  struct View {
    double all = 0.0;       ///< unoccluded form factor from the point to the polygon
    double hidden = 0.0;    ///< form factor to the hidden part, in [0, all]
    bool is_whole = true;   ///< all or nothing of the polygon is hidden
    std::uint32_t met = 0;  ///< bit k: the point is in reach of blocker k
  };
  /// View from `point`, before the polygon's plane, with unit normal `normal`. Exact up to
  /// rounding, unless a fragment has too many corners to be clipped.
  View view_from(const Eigen::Vector3d& point, const Eigen::Vector3d& normal);

 private:
  /// Subtracts the part that the blocker hides from the fragments. Returns the form factor of that
  /// part.
  double take_away(const Blocker& blocker, const Eigen::Vector3d& point,
                   const Eigen::Vector3d& normal);

  std::span<const ConvexPolygon> parts_;
  std::span<const Blocker> blockers_;
  std::vector<ConvexPolygon> fragments_, left_;
};

}  // namespace lightwell
