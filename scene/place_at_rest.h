#pragma once

#include "scene/scene.h"

namespace lightwell {

/// Puts surfaces and cameras where their motions have them at a time, s, from where a file has put
/// them, and says so in RigidMotion::rest_time: light is solved for what stands there then. To be
/// called once; motions must be sound (see fault()).
void place_at_rest(Scene& scene, double time);

}  // namespace lightwell
