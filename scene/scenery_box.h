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
Eigen::AlignedBox3d scenery_box(const std::vector<Eigen::AlignedBox3d>& boxes);
/// The same for the facets and round shapes of a scene.
Eigen::AlignedBox3d scenery_box(const Scene& scene);

/// The facets that a scene shows from near, and those that only surround it.
struct Scenery {
  Eigen::AlignedBox3d box{};      ///< of what is near, m
  std::vector<char> is_near{};    ///< by facet of the scene
  bool has_surroundings = false;  ///< false: all is near
};

/// A scene that is all near.
Scenery all_near(const Scene& scene);

/// Parts a scene at smaller distances than scenery_box(): each of the surroundings' facets reaches
/// at least twice as far from the middle as what is near is long, and the farthest 16 times as far.
/// A ground of 300 m about a room, and a land of triangles of 100 m, are such surroundings. Sizes
/// of patches follow the near part, for which the area of such surroundings would make them longer
/// than its walls.
Scenery near_scenery(const Scene& scene);
/// The length of the box of near_scenery(), m: what distances are shares of that stand for the
/// details of a scene.
double scenery_length(const Scene& scene);
/// Widest seams that stand for the rounding of vertices, over scenery_length(). Half a unit of the
/// fourth decimal is 5e-6 of 10 m. A room of 4 m x 5 m x 3 m, of which every edge is open that far,
/// gets 48 m x 50 um of 94 m2 of the light next door, twice that with reflections: 5e-5.
inline constexpr double seam_share = 5e-6;
/// scenery_length(), or the distance of the box from the origin if that is more, but no more than
/// the length of the scene: what distances are shares of that stand for the rounding of
/// coordinates.
double coordinate_length(const Scene& scene);
/// Flags of `boxes` (m, none empty): 1 for a box that is near as facets of near_scenery() are.
std::vector<char> are_near(const std::vector<Eigen::AlignedBox3d>& boxes);

}  // namespace lightwell
