#pragma once

#include "scene/scene.h"

namespace lightwell {

/// 10 by 10 by 3 metres, a lamp of a square metre under the ceiling and 100 boxes of different
/// sizes on the floor; all reflect half.
Scene room_of_boxes();

/// A unit cube with a lamp in its ceiling and two blocks on its floor, closed, all reflecting half,
/// that arrives cut up: into 41 rectangles along the lines of what stands in it (`cells` 0), or
/// into squares of 1/cells: 708 for 10, 2832 for 20. With `own_names` each polygon is a surface.
Scene room_of_polygons(int cells, bool own_names = false);

}  // namespace lightwell
