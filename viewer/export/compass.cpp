#include "viewer/export/compass.h"

#include <cmath>

#include "viewer/export/start_view.h"

namespace lightwell {

Sky compass_of(const Scene& scene, double north_degrees, const std::string& up) {
  Sky frame;
  if (scene.sky && up.empty()) {
    frame.up = scene.sky->up;
    frame.north = scene.sky->north;
  } else {
    frame.up = up.empty() ? guess_up_axis(scene.cameras, scene_bounds(scene))
                          : Eigen::Vector3d(Eigen::Vector3d::Unit(up == "y" ? 1 : 2));
    // Drawings have north along +y; scenes with y up, along -z.
    frame.north = std::abs(frame.up.y()) > 0.5 ? Eigen::Vector3d(-Eigen::Vector3d::UnitZ())
                                               : Eigen::Vector3d(Eigen::Vector3d::UnitY());
  }
  frame.north = sky_direction(frame, north_degrees, 0.0);
  return frame;
}

}  // namespace lightwell
