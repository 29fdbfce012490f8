#pragma once

#include "scene/io/mitsuba/mitsuba_colors.h"
#include "scene/io/mitsuba/mitsuba_tree.h"
#include "scene/io/remarks.h"
#include "scene/scene.h"

namespace lightwell {

/// Adds an infinitely distant <emitter> (constant, envmap, directional, sunsky, sky, sun) to the
/// scene's sky; false for other plugins. A second sky or sun is left out with a remark. Throws
/// InputError naming file, line and fault.
bool add_mitsuba_sky(const MitsubaNode& emitter, const MitsubaTree& tree, Scene& scene,
                     Remarks& remarks);

}  // namespace lightwell
