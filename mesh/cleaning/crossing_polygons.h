#pragma once

#include "scene/scene.h"

namespace lightwell {

/// Cuts the polygons of the scene that cross themselves into convex_pieces(), with a note and a
/// loss that count them. Readers have done so already; scenes that programs make may need it. A
/// polygon that only touches itself stays.
void cut_crossing_polygons(Scene& scene);

}  // namespace lightwell
