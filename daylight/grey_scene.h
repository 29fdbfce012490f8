#pragma once

#include "scene/scene.h"

namespace lightwell {

/// A scene of one band in place of a scene whose materials are alike in all bands. The work falls
/// with the number of bands. Other scenes, and those with pictures on surfaces, are returned as
/// they are. Lamps, emission and sky, which are not looked at, must be gone.
Scene with_one_band_if_grey(Scene scene);

}  // namespace lightwell
