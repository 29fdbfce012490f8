#pragma once

#include "scene/io/toml/toml_value.h"
#include "scene/scene.h"

namespace lightwell {

/// The [motions.NAME] tables of a scene file.
std::vector<RigidMotion> read_toml_motions(const TomlValue& value, double metres_per_unit);

/// Index of the motion that a `motion` key names.
int find_toml_motion(const TomlValue& value, const Scene& scene);

/// A camera's `shutter`: two times in seconds, the second not before the first.
void read_toml_shutter(const TomlValue& value, Camera& camera);

/// Puts what moves where it is in the middle of the shutter, which all cameras that `have_shutter`
/// must agree upon, or at 0 s if none has one. Cameras without get that instant.
void settle_toml_motions(const TomlTable& document, const std::vector<char>& have_shutter,
                         Scene& scene);

}  // namespace lightwell
