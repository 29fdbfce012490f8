#pragma once

#include "scene/io/toml/toml_value.h"
#include "scene/scene.h"

namespace lightwell {

/// Reads the [motions.NAME] tables of a scene file.
std::vector<RigidMotion> read_toml_motions(const TomlValue& value, double metres_per_unit);

/// Index in Scene::motions of the motion named by a `motion` key.
int find_toml_motion(const TomlValue& value, const Scene& scene);

/// Reads a camera's `shutter`: two times in seconds, the second not before the first.
void read_toml_shutter(const TomlValue& value, Camera& camera);

/// Places moving surfaces where they are in the middle of the shutter, or at 0 s if no camera has a
/// shutter. Cameras without a shutter get an instantaneous shutter at that time. Throws InputError
/// if the shutters of the cameras that `have_shutter` differ in their middle.
void settle_toml_motions(const TomlTable& document, const std::vector<char>& have_shutter,
                         Scene& scene);

}  // namespace lightwell
