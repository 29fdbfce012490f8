#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "radiosity/visibility/shaft.h"

namespace lightwell {

/// What an occluder hides of a target from points on one side of its plane.
struct Blocker {
  ConvexPolygon polygon{};   ///< clockwise seen from the points
  HalfSpace plane{};         ///< of the polygon; the points are at height > 0
  bool cuts_target = false;  ///< some of the target lies on the points' side too
  /// Points of which any is at height < 0 see all of the target past the blocker.
  std::vector<HalfSpace> reach{};

  bool reaches(const Eigen::Vector3d& point) const {
    for (const HalfSpace& bound : reach) {
      if (!(bound.height(point) > 0.0)) return false;
    }
    return true;
  }
};

/// The occluder as seen from the points before (`side` 1) or behind (-1) its plane, as far as it
/// hides something of `target` from some of the points of `from`; false if it does not. `reach` is
/// the outside of the penumbra: planes through an edge of one and a corner of the other that part
/// occluder and target.
bool make_blocker(const Occluder& occluder, int side, const ShaftEnd& from, const ShaftEnd& target,
                  double tolerance, Blocker& blocker);

/// The same as seen from a single point of known height over the occluder's plane: without `reach`.
/// `from` is what the point can see, `target` what the target's plane can, `corners` all of the
/// target's.
bool make_point_blocker(const Occluder& occluder, int side, const HalfSpace& from,
                        const HalfSpace& target, std::span<const Eigen::Vector3d> corners,
                        double tolerance, Blocker& blocker);

/// Leaves of the polygon what the blocker reaches; false if that is nothing.
bool clip_to_reach(ConvexPolygon& polygon, const Blocker& blocker);

/// A polygon with others before it. From a point, what a convex occluder hides is the part of the
/// polygon inside the pyramid from the point over the occluder's edges; several hide the union,
/// which is taken away piece by piece, so that nothing is taken twice.
class ShadowedPolygon {
 public:
  static constexpr int most_blockers = 32;

  ShadowedPolygon() = default;  ///< nothing, until set() says what
  /// `parts` tile the polygon, counter-clockwise seen from the points. Both are kept by reference.
  ShadowedPolygon(std::span<const ConvexPolygon> parts, std::span<const Blocker> blockers)
      : parts_(parts), blockers_(blockers) {}
  /// Another polygon, or other blockers: the same memory serves.
  void set(std::span<const ConvexPolygon> parts, std::span<const Blocker> blockers) {
    parts_ = parts;
    blockers_ = blockers;
  }

  struct View {
    double all = 0.0;       ///< form factor from the point to the polygon
    double hidden = 0.0;    ///< of which hidden, [0, all]
    bool is_whole = true;   ///< all or nothing of the polygon is hidden
    std::uint32_t met = 0;  ///< bit k: blocker k reaches the point
  };
  /// From a point before the polygon's plane with unit normal `normal`. Exact up to rounding.
  View view_from(const Eigen::Vector3d& point, const Eigen::Vector3d& normal);

 private:
  /// Takes what the blocker hides off the fragments; the form factor of that.
  double take_away(const Blocker& blocker, const Eigen::Vector3d& point,
                   const Eigen::Vector3d& normal);

  std::span<const ConvexPolygon> parts_;
  std::span<const Blocker> blockers_;
  std::vector<ConvexPolygon> fragments_, left_;
};

}  // namespace lightwell
