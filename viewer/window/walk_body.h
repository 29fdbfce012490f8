#pragma once

#include <Eigen/Core>
#include <vector>

#include "viewer/window/visible_hits.h"

namespace lightwell {

/// A person on foot: an upright cylinder that carries the eye. Metres, seconds.
struct WalkBody {
  double eye_height = 1.6;
  double radius = 0.25;
  double step = 0.3;       ///< what it climbs without a jump
  double above_eye = 0.1;  ///< to the top of the head
  double jump_height = 0.45;
  double gravity = 9.81;  ///< m/s^2
};

/// A person, or, in a scene that is neither as high as a room (2.5 m) nor as large (7 m across), a
/// doll in the proportion that is nearer, so that one can walk through a model. An eye height above
/// 0 is kept and the rest goes with it.
WalkBody walk_body(const Bounds& bounds, const Eigen::Vector3d& up_axis, double eye_height = 0.0);

/// What is drawn of a scene, as an obstacle. What shows only its back does not stop anybody, as it
/// does not stop the eye.
struct Obstacles {
  const ElementCaster& caster;
  const std::vector<ElementKind>& kinds;
  VisibleHitOptions options{.glass = true};
};

/// Moves a body through a scene by rays at five heights: 16 around, and a fan of parallel ones over
/// its whole width on the way it goes, a twelfth of its radius apart, so that a post of 3 cm cannot
/// slip between two. Upright rays find boards that jut out between those heights, which are then
/// looked at as well. What is thinner may be brushed through.
class WalkPhysics {
 public:
  WalkPhysics(const WalkBody& body, const Eigen::Vector3d& up_axis);

  /// Where the eye comes to that wants to go a level `way`: stopped by what is in front, sliding
  /// along it, a body's radius away.
  Eigen::Vector3d move(const Obstacles& obstacles, const Eigen::Vector3d& eye,
                       const Eigen::Vector3d& way) const;
  /// `seconds` of weight: up a step, down one, or falling to what is below. Where there is nothing
  /// below, the eye keeps its height.
  Eigen::Vector3d settle(const Obstacles& obstacles, const Eigen::Vector3d& eye, double seconds);
  /// Leaves the ground, if it stands on it.
  void jump();
  void stand_still() { rising_ = 0.0; }
  bool is_on_ground() const { return on_ground_; }
  const WalkBody& body() const { return body_; }

 private:
  /// A place that the body may have to be pushed away from.
  struct Contact {
    double depth = 0.0;
    Eigen::Vector3d out = Eigen::Vector3d::Zero();  ///< level, unit
  };
  bool push_out(const Obstacles& obstacles, Eigen::Vector3d& eye, const Eigen::Vector3d& way) const;
  std::vector<double> heights(const Obstacles& obstacles, const Eigen::Vector3d& eye,
                              const Eigen::Vector3d& ahead) const;
  Contact deepest_around(const Obstacles& obstacles, const Eigen::Vector3d& eye,
                         const std::vector<double>& drops) const;
  Contact deepest_ahead(const Obstacles& obstacles, const Eigen::Vector3d& eye,
                        const std::vector<double>& drops, const Eigen::Vector3d& ahead) const;
  Eigen::Vector3d settle_a_moment(const Obstacles& obstacles, const Eigen::Vector3d& eye,
                                  double seconds);

  WalkBody body_;
  Eigen::Vector3d up_, a_, b_;
  double rising_ = 0.0;  ///< m/s
  bool on_ground_ = false;
};

}  // namespace lightwell
