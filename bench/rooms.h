#pragma once

#include "scene/scene.h"

namespace lightwell {

/// A room of 10 m x 10 m x 3 m with a lamp of 1 m^2 under the ceiling and 100 boxes of different
/// sizes on the floor; every surface reflects half.
Scene room_of_boxes();

/// A closed unit cube with a lamp in its ceiling and two blocks on its floor, of reflectance 0.5
/// but for the black lamp. Its faces are given as
/// - 41 rectangles along the outlines of blocks and lamp, for `cells` 0, or
/// - squares of edge 1/cells: 708 for 10, 2832 for 20.
/// With `own_names` each polygon is a surface, otherwise all polygons of a material.
Scene room_of_polygons(int cells, bool own_names = false);

}  // namespace lightwell
