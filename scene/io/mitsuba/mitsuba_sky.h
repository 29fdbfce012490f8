#pragma once

#include "scene/io/mitsuba/mitsuba_colors.h"
#include "scene/io/mitsuba/mitsuba_tree.h"
#include "scene/io/remarks.h"
#include "scene/scene.h"

namespace lightwell {

/// Takes an <emitter> that is infinitely far away into the scene's sky: constant, envmap and
/// directional. False for other plugins. What cannot be kept (a second sky or sun) gets a remark.
/// Throws InputError naming file, line and what is wrong.
bool add_mitsuba_sky(const MitsubaNode& emitter, const MitsubaTree& tree, Scene& scene,
                     Remarks& remarks);

}  // namespace lightwell
