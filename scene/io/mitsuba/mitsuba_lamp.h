#pragma once

#include "scene/io/mitsuba/mitsuba_colors.h"
#include "scene/io/mitsuba/mitsuba_tree.h"
#include "scene/scene.h"

namespace lightwell {

/// Adds an <emitter> of the plugins point and spot (0.6 and 2, 3) as a lamp; false if it is of
/// another. A spot shines along its +z, in full up to beam_width from its axis and with nothing
/// from cutoff_angle on. Throws InputError naming file and line.
bool add_mitsuba_lamp(const MitsubaNode& emitter, MitsubaColors& colors, Scene& scene);

}  // namespace lightwell
