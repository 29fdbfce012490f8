#pragma once

#include "scene/io/mitsuba/mitsuba_tree.h"
#include "scene/io/remarks.h"
#include "scene/scene.h"

namespace lightwell {

/// Adds the camera of a <sensor> (perspective, or thinlens with its lens). Other kinds and
/// properties without an equivalent add a remark. Throws InputError naming file and line.
void add_mitsuba_camera(const MitsubaNode& sensor, const MitsubaTree& tree, Scene& scene,
                        Remarks& remarks);

}  // namespace lightwell
