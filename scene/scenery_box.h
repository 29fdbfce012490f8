#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "scene/scene.h"

namespace lightwell {

/// The box, m, of what a scene shows from near: of all `boxes` (of facets and round shapes, none
/// empty), or without its backdrop, such as a dome or a ground that stand for the sky and the land.
///
/// A backdrop reaches a hundred times as far from the middle of all smaller boxes, of six or more,
/// as the box of these is long, with each of its facets. Coordinates in single precision are exact
/// to a few micrometres in a room of 10 m, but to half a millimetre about the middle of a dome of
/// 3 km, so distances that stand for rounding follow the scenery.
Eigen::AlignedBox3d scenery_box(std::vector<Eigen::AlignedBox3d> boxes);
/// The same for the facets and round shapes of a scene.
Eigen::AlignedBox3d scenery_box(const Scene& scene);

}  // namespace lightwell
