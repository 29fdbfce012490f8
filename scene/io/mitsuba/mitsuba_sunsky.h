#pragma once

#include "scene/io/mitsuba/mitsuba_colors.h"
#include "scene/io/mitsuba/mitsuba_tree.h"
#include "scene/io/remarks.h"
#include "scene/sky.h"

namespace lightwell {

/// Parts of a sky that come of an emitter.
struct SkyParts {
  bool dome = false, sun = false;
};

/// Parts of the emitters `sunsky`, `sky` and `sun`; neither for others.
SkyParts clear_day_parts(const MitsubaNode& emitter);

/// Sets the `parts` of `sky` from a clear day by turbidity, with the axes and the sun's model
/// of the file's version: before Mitsuba 2, +Y is up, -Z north and +X east; later +Z is up, -X
/// north and -Y east. Throws InputError naming file, line and value for values out of range and a
/// sun below the horizon; `sky` is then half set.
void set_clear_day(const MitsubaNode& emitter, const MitsubaTree& tree, MitsubaColors& colors,
                   Remarks& remarks, const SkyParts& parts, Sky& sky);

}  // namespace lightwell
