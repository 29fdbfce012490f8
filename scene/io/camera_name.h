#pragma once

#include <Eigen/Geometry>
#include <string>

#include "scene/io/remarks.h"
#include "scene/scene.h"

namespace lightwell {

/// A name for the scene's next camera that no other has and that pictures can be called after:
/// `wanted`, its slashes replaced, or "camera1", "camera2" ...
std::string camera_name(std::string wanted, const Scene& scene);

/// Puts a camera where a file's transformation has it: at its translation, upright along its y axis
/// and looking along `ahead`, a direction before the transformation. A picture is never mirrored,
/// which is remarked upon. False if the transformation leaves no direction or no upright.
bool place_camera(const Eigen::Affine3d& to_world, const Eigen::Vector3d& ahead, Camera& camera,
                  Remarks& remarks);

}  // namespace lightwell
