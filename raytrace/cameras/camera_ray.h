#pragma once

#include <optional>

#include "raytrace/cameras/picture_plane.h"
#include "raytrace/cameras/pixel_cone.h"
#include "scene/rays/ray_caster.h"
#include "scene/scene.h"

namespace lightwell {

/// Rays of a camera through the points of its picture, see PicturePlane. x and y count pixels from
/// the left and from the top: (0, 0) is the corner and (0.5, 0.5) the centre of the first pixel.
///
/// With a lens, the rays of one picture point leave from all points of the lens and meet again on
/// the plane at f = Camera::focus_distance (thin lens; Cook, Porter & Carpenter 1984). On that
/// plane a point at distance d appears as a disk whose size, relative to the lens, is |d-f| / d.
///
/// A ray begins at Camera::near_distance and ends at Camera::far_distance. The eyes of a stereo
/// panorama are on a circle about the position, at right angles to each ray's longitude
/// (omni-directional stereo; Peleg, Ben-Ezra & Pritch 2001).
class CameraRays {
 public:
  /// Throws InputError unless width and height are positive, with at most max_image_pixels pixels,
  /// and as validate(camera).
  explicit CameraRays(const Camera& camera);

  /// Returns the ray through the picture point (x, y) from the centre of the lens, with unit
  /// direction; empty where the picture shows nothing. `panel` is that of the pixel to which the
  /// point counts: a panel ends with its own pixels, although rays continue beyond.
  std::optional<Ray> ray_at(double x, double y, int panel) const;
  /// Returns the ray through the picture point (x, y) from the lens point of (u, v) in [0,1)^2.
  /// Lens points are spread evenly over the lens. A pinhole has one lens point, its centre.
  std::optional<Ray> ray_at(double x, double y, double u, double v, int panel) const;
  /// The same in the panel at the point.
  std::optional<Ray> ray_at(double x, double y) const { return ray_at(x, y, panel_at(x, y)); }
  /// The same for cameras that show something everywhere, such as perspectives without distortion.
  /// Throws std::bad_optional_access where there is nothing.
  Ray ray(double x, double y) const { return ray_at(x, y).value(); }
  Ray ray(double x, double y, double u, double v) const {
    return ray_at(x, y, u, v, panel_at(x, y)).value();
  }

  int panel_at(double x, double y) const { return plane_.panel_at(x, y); }
  /// Returns the cone of the pixel at the picture point (x, y).
  PixelCone cone(double x, double y, int panel) const;
  /// Returns the picture point that shows a point of the world, also behind other things and
  /// outside of the picture; empty if none does. Of a stereo panorama, that of the eye `panel`.
  std::optional<Eigen::Vector2d> picture_point(const Eigen::Vector3d& point, int panel = 0) const;
  /// Distance of a point of a ray from the camera, m: along Camera::direction if pictures are flat,
  /// otherwise from its position.
  double depth(const Eigen::Vector3d& point) const;

  const PicturePlane& plane() const { return plane_; }
  bool has_lens() const { return lens_radius_ > 0.0; }

 private:
  Eigen::Vector2d lens_point(double u, double v) const;  // on a lens of radius 1
  Ray ray_from(const Eigen::Vector3d& eye, const Eigen::Vector3d& direction) const;

  PicturePlane plane_;
  Eigen::Vector3d position_;
  Eigen::Matrix3d axes_;  // columns: right, up, ahead
  double near_ = 0.0, far_ = 0.0;
  double lens_radius_ = 0.0, focus_distance_ = 1.0;
  int blades_ = 0;
};

}  // namespace lightwell
