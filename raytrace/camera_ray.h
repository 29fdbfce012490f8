#pragma once

#include "scene/rays/ray_caster.h"
#include "scene/scene.h"

namespace lightwell {

/// Rays of a camera. The picture plane at distance 1 spans 2 tan(fov/2) in width; its x axis is
/// direction x up, and pixels are square. With a lens, the rays of one picture point leave from all
/// points of the lens and meet again on the plane at f = Camera::focus_distance (thin lens; Cook,
/// Porter & Carpenter 1984). On that plane a point at distance d appears as a disk whose size,
/// relative to the lens, is |d-f| / d.
class CameraRays {
 public:
  /// Throws InputError unless width and height are positive, with at most max_image_pixels pixels,
  /// and as validate(camera).
  explicit CameraRays(const Camera& camera);

  /// Returns the ray through the picture point (x, y) from the centre of the lens, with unit
  /// direction. x and y count pixels from the left and from the top: (0, 0) is the corner and (0.5,
  /// 0.5) the centre of the first pixel.
  Ray ray(double x, double y) const;
  /// Returns the ray through the picture point (x, y) from the lens point of (u, v) in [0,1)^2.
  /// Lens points are spread evenly over the lens. A pinhole has one lens point, its centre.
  Ray ray(double x, double y, double u, double v) const;

  /// Width of a pixel in the middle of the picture plane, in metres at a distance of one metre.
  double pixel_width() const { return step_down_.norm(); }
  bool has_lens() const { return lens_radius_ > 0.0; }

 private:
  Eigen::Vector2d lens_point(double u, double v) const;  // on a lens of radius 1

  Eigen::Vector3d position_, top_left_, step_right_, step_down_;
  Eigen::Vector3d lens_right_, lens_up_;  // vectors as long as the lens radius, m
  double lens_radius_ = 0.0, focus_distance_ = 1.0;
  int blades_ = 0;
};

}  // namespace lightwell
