#pragma once

#include <Eigen/Geometry>

#include "scene/io/json_object.h"
#include "scene/io/remarks.h"
#include "scene/scene.h"

namespace lightwell {

/// Adds a perspective camera of a glTF file, 512 pixels high since glTF has no picture size. Other
/// kinds of camera add a remark. `node` places the camera. Throws InputError naming the place in
/// the file.
void add_gltf_camera(const JsonObject& camera, const JsonObject& node,
                     const Eigen::Affine3d& to_world, Scene& scene, Remarks& remarks);

}  // namespace lightwell
