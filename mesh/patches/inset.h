#pragma once

#include <Eigen/Core>

namespace lightwell {

struct PatchMesh;

/// Distance from the border of an element, metres, below which rays do not tell its two sides: 16
/// times the rounding of coordinates in single precision, of half the mesh's diagonal.
double least_inset(const PatchMesh& mesh);

/// Displacement of a point of an element towards `center`: `share` of the way, but at least `least`
/// metres, as far as half of the way allows.
Eigen::Vector3d inset(const Eigen::Vector3d& point, const Eigen::Vector3d& center, double share,
                      double least);

}  // namespace lightwell
