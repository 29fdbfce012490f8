#pragma once

#include <Eigen/Geometry>

#include "scene/io/gltf/gltf_object.h"
#include "scene/io/remarks.h"
#include "scene/scene.h"

namespace lightwell {

/// Adds a point or a spot light of KHR_lights_punctual as a lamp: candela are taken as emission is,
/// as relative. `node` is where it stands; it shines along its -z. Directional lights, and ranges,
/// beyond which the light would end, are remarked upon. Throws InputError naming its place.
void add_gltf_light(const GltfObject& light, const GltfObject& node,
                    const Eigen::Affine3d& to_world, Scene& scene, Remarks& remarks);

}  // namespace lightwell
