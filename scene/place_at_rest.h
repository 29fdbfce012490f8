#pragma once

#include "scene/scene.h"

namespace lightwell {

/// Moves surfaces and cameras from their coordinates in the file to the poses of their motions at
/// `time`, s, and sets RigidMotion::rest_time: light is solved for that instant. To be called once;
/// motions must be sound (see fault()).
void place_at_rest(Scene& scene, double time);

}  // namespace lightwell
