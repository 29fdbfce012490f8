#pragma once

#include <Eigen/Core>
#include <string>

#include "scene/bands.h"
#include "scene/io/remarks.h"
#include "scene/scene.h"

namespace lightwell {

/// Makes a directional light of a file the scene's sun, with a remark. `towards` points to the
/// light and has a length; `irradiance` is that of a plane across the light. A second directional
/// light is left out with a remark.
void add_directional_light(const Eigen::Vector3d& towards, const Spectrum& irradiance,
                           const std::string& name, Scene& scene, Remarks& remarks);

}  // namespace lightwell
