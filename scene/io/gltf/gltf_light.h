#pragma once

#include <Eigen/Geometry>

#include "scene/io/json_object.h"
#include "scene/io/remarks.h"
#include "scene/scene.h"

namespace lightwell {

/// Adds a light of KHR_lights_punctual. Point and spot lights become lamps whose candela are taken
/// as relative, as emission is; a spot's axis is the -z of `node`. A directional light becomes the
/// scene's sun, which is remarked upon. A second sun, other types, and ranges (distances beyond
/// which a light ends) are left out with a remark. Throws InputError naming the place in the file.
void add_gltf_light(const JsonObject& light, const JsonObject& node,
                    const Eigen::Affine3d& to_world, Scene& scene, Remarks& remarks);

}  // namespace lightwell
