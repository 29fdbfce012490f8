#pragma once

#include <string>

#include "scene/scene.h"
#include "scene/sky.h"

namespace lightwell {

/// Zenith and north of a scene in a sky without light: those of the scene's sky, or those that its
/// axes suggest (north is +y, or -z where y is up). `north_degrees` turns north clockwise as seen
/// from above. `up`, "y" or "z" where it is given, is the zenith instead.
Sky compass_of(const Scene& scene, double north_degrees, const std::string& up = {});

}  // namespace lightwell
