#pragma once

#include "scene/scene.h"

namespace lightwell {

/// Material of geometry without a material: diffuse, reflectance 0.5 in every band.
Material default_material(const Bands& bands);

}  // namespace lightwell
