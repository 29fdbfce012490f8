#pragma once

#include <Eigen/Core>
#include <vector>

#include "viewer/window/visible_hits.h"

namespace lightwell {

/// A person on foot: an upright cylinder that carries the eye. Metres, seconds.
struct WalkBody {
  double eye_height = 1.6;
  double radius = 0.25;
  double step = 0.3;       ///< highest step that needs no jump
  double above_eye = 0.1;  ///< from the eye to the top of the head
  double jump_height = 0.45;
  double gravity = 9.81;  ///< m/s^2
};

/// Returns the body for a scene:
/// - `eye_height` (m) above 0: a person scaled to this eye height;
/// - a scene as high as a room (2.5 m) or as large (7 m in diagonal): a person of full size;
/// - a smaller scene, such as a model: a person scaled by the larger of height / 2.5 m and
///   diagonal / 7 m.
WalkBody walk_body(const Bounds& bounds, const Eigen::Vector3d& up_axis, double eye_height = 0.0);

/// The drawn surfaces of a scene, as obstacles. The back of a surface stops neither the eye nor the
/// body.
struct Obstacles {
  const ElementCaster& caster;
  const std::vector<ElementKind>& kinds;
  VisibleHitOptions options{.glass = true};
};

/// Moves a body through a scene, with rays that detect obstacles:
/// - at each of five heights, 16 rays around the body;
/// - at the same heights, a fan of parallel rays along the motion over the body's width, a twelfth
///   of the radius apart, so that a post of 3 cm is hit;
/// - upright rays ahead of the body, which detect boards that jut out between the five heights. The
///   height of each such board is tested too.
/// The body may pass through thinner obstacles.
class WalkPhysics {
 public:
  WalkPhysics(const WalkBody& body, const Eigen::Vector3d& up_axis);

  /// Returns the eye after a level displacement `way` (m). The body stays a radius away from
  /// obstacles and slides along them.
  Eigen::Vector3d move(const Obstacles& obstacles, const Eigen::Vector3d& eye,
                       const Eigen::Vector3d& way) const;
  /// Returns the eye after `seconds` of gravity: the body steps up or down, or falls to the ground
  /// below. Without ground below, the eye keeps its height.
  Eigen::Vector3d settle(const Obstacles& obstacles, const Eigen::Vector3d& eye, double seconds);
  /// Begins a jump, if the body stands on the ground.
  void jump();
  /// Sets the vertical speed to 0.
  void stand_still() { rising_ = 0.0; }
  bool is_on_ground() const { return on_ground_; }
  const WalkBody& body() const { return body_; }

 private:
  /// An obstacle nearer than the body's radius.
  struct Contact {
    double depth = 0.0;                             ///< m, overlap of body and obstacle
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
