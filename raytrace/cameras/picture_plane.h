#pragma once

#include <Eigen/Core>
#include <optional>

#include "scene/camera.h"

namespace lightwell {

/// Map between the places of a picture and directions. A picture consists of one panel, or of
/// several: two eyes, six faces. The plane of a panel has its origin in the direction of the view,
/// x to the right, y upwards, and lengths that depend on the projection:
///
/// - perspective, cube map: tangents; orthographic: metres;
/// - fisheyes: r of Projection; cylindrical: radians of longitude, and tangents of elevation;
/// - equirectangular: radians of longitude and elevation.
///
/// Directions are in the camera's own frame: x to the right, y along Camera::up, z ahead.
class PicturePlane {
 public:
  /// `camera` must be without fault, see projection_fault.
  explicit PicturePlane(const Camera& camera);

  int panel_columns() const { return columns_; }
  int panel_count() const { return columns_ * rows_; }
  /// Panel of the picture point (x, y), given in pixels from the top left corner; of points outside
  /// the picture that of the nearest pixel.
  int panel_at(double x, double y) const;

  /// Place on the plane of a panel of the picture point (x, y), which may lie outside of the panel.
  Eigen::Vector2d place(double x, double y, int panel) const;
  /// Inverse of place().
  Eigen::Vector2d picture_point(const Eigen::Vector2d& place, int panel) const;

  /// Direction that is shown at a place, of unit length; empty where nothing is shown: outside of a
  /// fisheye's circle and of what a distorted lens shows. Orthographic: ahead.
  std::optional<Eigen::Vector3d> direction(const Eigen::Vector2d& place, int panel) const;
  /// Place of a point (x, y, z) of the camera's frame, which is the inverse of direction() along
  /// the ray from the eye; empty if the camera does not show the point.
  std::optional<Eigen::Vector2d> place_of(const Eigen::Vector3d& point, int panel) const;
  /// Panel that shows a direction; of a stereo panorama 0, the left eye.
  int panel_of(const Eigen::Vector3d& direction) const;

  /// Place in a pinhole's picture of a place in the picture of a distorted lens; empty where the
  /// lens shows nothing. The same place without distortion.
  std::optional<Eigen::Vector2d> without_distortion(const Eigen::Vector2d& place) const;
  /// Offset of the eye in the camera's frame from its position: of stereo panoramas, at right
  /// angles to a direction.
  Eigen::Vector3d eye(const Eigen::Vector3d& direction, int panel) const;

  /// Solid angle of a place per area of the plane; 0 for an orthographic picture.
  double solid_angle_density(const Eigen::Vector2d& place) const;
  /// Edge of a pixel on the plane.
  double pixel() const { return pixel_; }
  /// Radius of a fisheye's circle on the plane; infinite for other projections.
  double circle() const { return circle_; }
  Projection projection() const { return projection_; }

 private:
  Projection projection_;
  LensDistortion distortion_;
  double fold_ = 0.0;
  int columns_ = 1, rows_ = 1;
  double panel_width_ = 0.0, panel_height_ = 0.0;  // pixels
  double left_ = 0.0, top_ = 0.0;  // pixels from the plane's origin to the panel's top left corner
  double pixel_ = 0.0;
  double circle_ = 0.0;
  double half_separation_ = 0.0;  // m
};

}  // namespace lightwell
