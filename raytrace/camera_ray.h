#pragma once

#include "scene/ray_caster.h"
#include "scene/scene.h"

namespace lightwell {

/// The pinhole camera's rays. The picture plane at distance 1 spans 2 tan(fov/2) in width; its x
/// axis is direction x up, its pixels are square.
class CameraRays {
 public:
  /// Throws InputError unless the size is positive, 0 < fov < 180, and direction and up are unit
  /// vectors at right angles (within 1e-6).
  explicit CameraRays(const Camera& camera);

  /// Through the point (x, y) of the picture: pixels from the left and from the top, so (0, 0) is
  /// the corner and (0.5, 0.5) the centre of the first pixel. Unit direction.
  Ray ray(double x, double y) const;

 private:
  Eigen::Vector3d position_, top_left_, step_right_, step_down_;
};

}  // namespace lightwell
