#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "scene/scene.h"

namespace lightwell {

/// Places of the scene's lamps for rays, m: those of the lamps, but moved to twice the `clearance`,
/// m, of each from surfaces that are nearer. Rays that begin or end at the clearance from a lamp
/// then neither pass the ceiling that the lamp hangs from nor meet it by rounding.
///
/// A lamp keeps the side of a surface on which it is. Lamps on a surface, to the digits of
/// single-precision files (weld_share of the scene's diagonal), go to the side to which their
/// intensity along the normal is larger; if there is none, to the front. A one-sided surface has
/// lamps before its front alone. A lamp between surfaces nearer to each other than four
/// clearances goes to their middle.
std::vector<Eigen::Vector3d> clear_places(const Scene& scene, std::span<const double> clearance);

}  // namespace lightwell
