#pragma once

#include "scene/scene.h"

namespace lightwell {

/// The material of geometry that names none: diffuse, reflectance 0.5 in every band.
Material default_material(const Bands& bands);

}  // namespace lightwell
