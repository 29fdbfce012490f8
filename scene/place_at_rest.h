#pragma once

#include "scene/scene.h"

namespace lightwell {

/// Moves surfaces and cameras from their coordinates in the file to the poses of their motions at
/// `time`, s, and sets RigidMotion::rest_time: light is solved for that instant. To be called once;
/// motions must be sound (see fault()).
void place_at_rest(Scene& scene, double time);

/// Moves one more camera, whose coordinates are those of the file, to its pose at the rest time of
/// the motions of a scene that is placed already.
void place_at_rest(const Scene& scene, Camera& camera);

/// The camera of such a scene with the coordinates that it has in the file.
Camera placed_as_in_file(const Scene& scene, const Camera& camera);

}  // namespace lightwell
