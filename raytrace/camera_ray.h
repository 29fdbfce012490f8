#pragma once

#include "scene/rays/ray_caster.h"
#include "scene/scene.h"

namespace lightwell {

/// The camera's rays. The picture plane at distance 1 spans 2 tan(fov/2) in width; its x axis is
/// direction x up, its pixels are square. With a lens, rays of one picture point leave from all of
/// it and meet again on the plane at Camera::focus_distance (thin lens; Cook, Porter & Carpenter
/// 1984): a point at distance d is a disk of |d - f| / d of the lens there.
class CameraRays {
 public:
  /// Throws InputError unless the size is positive, 0 < fov < 180, direction and up are unit
  /// vectors at right angles (within 1e-6), the lens is none or one that can be, and the shutter
  /// closes no sooner than it opens.
  explicit CameraRays(const Camera& camera);

  /// Through the point (x, y) of the picture: pixels from the left and from the top, so (0, 0) is
  /// the corner and (0.5, 0.5) the centre of the first pixel. Unit direction.
  Ray ray(double x, double y) const;
  /// The same from a place on the lens: (u, v) in [0,1)^2 is spread evenly over it. A pinhole has
  /// one place only.
  Ray ray(double x, double y, double u, double v) const;

  /// Width of a pixel in the middle of the picture, in metres one metre away.
  double pixel_width() const { return step_down_.norm(); }
  bool has_lens() const { return lens_radius_ > 0.0; }

 private:
  Eigen::Vector2d lens_point(double u, double v) const;  // of a lens of radius 1

  Eigen::Vector3d position_, top_left_, step_right_, step_down_;
  Eigen::Vector3d lens_right_, lens_up_;  // m, of its radius
  double lens_radius_ = 0.0, focus_distance_ = 1.0;
  int blades_ = 0;
};

}  // namespace lightwell
