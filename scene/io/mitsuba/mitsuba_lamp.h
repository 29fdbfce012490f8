#pragma once

#include "scene/io/mitsuba/mitsuba_colors.h"
#include "scene/io/mitsuba/mitsuba_tree.h"
#include "scene/scene.h"

namespace lightwell {

/// Adds an <emitter> of the plugins point and spot (0.6, 2 and 3) as a lamp; false for other
/// plugins. The axis of a spot is its +z. Intensity is full up to beam_width from the axis and 0
/// from cutoff_angle on. Throws InputError naming file and line.
bool add_mitsuba_lamp(const MitsubaNode& emitter, MitsubaColors& colors, Scene& scene);

}  // namespace lightwell
