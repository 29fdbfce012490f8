#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <vector>

#include "scene/io/polygon.h"

namespace lightwell {

/// A plane with the unit normal towards the outside: points with normal . p <= distance are inside.
struct PovHalfSpace {
  Eigen::Vector3d normal = Eigen::Vector3d::UnitY();
  double distance = 0.0;
};

/// A convex body: the points inside all its planes. A face lies in each plane, counter-clockwise
/// seen from outside; a face may have no corners where the body is unbounded.
struct PovConvex {
  std::vector<PovHalfSpace> planes{};
  std::vector<Loop> faces{};
};

/// Body of convex faces, if no corner lies outside of a face's plane. Empty planes otherwise.
PovConvex pov_convex(std::vector<Loop> faces);

/// Part of the boundary of one of the bodies that a difference or an intersection is made of.
struct PovCutFace {
  std::size_t body = 0;
  Loop loop{};
};

/// Boundary of the points that are inside `first` and inside none of `others`. Faces of `others`
/// are turned over. `size` is that of the bodies, m.
std::vector<PovCutFace> pov_difference(const PovConvex& first, const std::vector<PovConvex>& others,
                                       double size);

/// Boundary of the points that are inside all `bodies`.
std::vector<PovCutFace> pov_intersection(const std::vector<PovConvex>& bodies, double size);

}  // namespace lightwell
