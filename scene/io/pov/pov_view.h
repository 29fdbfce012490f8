#pragma once

#include "scene/io/pov/pov_value.h"
#include "scene/io/remarks.h"
#include "scene/scene.h"

namespace lightwell {

/// Adds a block camera. Throws InputError for a camera that sees nothing.
void add_pov_camera(const PovNode& camera, Scene& scene, Remarks& remarks);

/// Adds a block sky_sphere or background: a dome of even radiance above and below the horizon; the
/// later of two stays. Colours become linear by the power `gamma`.
void add_pov_sky(const PovNode& sky, double gamma, Scene& scene, Remarks& remarks);

}  // namespace lightwell
