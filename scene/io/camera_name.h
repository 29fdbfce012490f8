#pragma once

#include <Eigen/Geometry>
#include <string>

#include "scene/io/remarks.h"
#include "scene/scene.h"

namespace lightwell {

/// Longest name of a camera, bytes: file systems limit names to 255, extensions included.
inline constexpr std::size_t longest_camera_name = 200;

/// Returns a unique name for the scene's next camera that is usable as a file name: `wanted`, its
/// slashes replaced by '_', or "camera1", "camera2" ... where `wanted` is empty, begins with a dot,
/// is longer than longest_camera_name or is taken.
std::string camera_name(std::string wanted, const Scene& scene);

/// Sets a camera's position and axes by a file's transformation: position at the translation, view
/// direction `ahead` (given before the transformation), up along the transformed y axis. A
/// mirroring transformation adds a remark and leaves the picture unmirrored. Returns false if the
/// view direction vanishes or is parallel to the up direction.
bool place_camera(const Eigen::Affine3d& to_world, const Eigen::Vector3d& ahead, Camera& camera,
                  Remarks& remarks);

}  // namespace lightwell
