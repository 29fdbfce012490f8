#pragma once

#include <Eigen/Geometry>

#include "scene/io/gltf/gltf_object.h"
#include "scene/io/remarks.h"
#include "scene/scene.h"

namespace lightwell {

/// Adds a perspective camera of a glTF file, 512 pixels high, since glTF names no size; other kinds
/// are remarked upon. `node` is where it stands. Throws InputError naming its place in the file.
void add_gltf_camera(const GltfObject& camera, const GltfObject& node,
                     const Eigen::Affine3d& to_world, Scene& scene, Remarks& remarks);

}  // namespace lightwell
