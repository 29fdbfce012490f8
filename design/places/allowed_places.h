#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "scene/scene.h"

namespace lightwell {

/// Box that holds a lamp, and its least distance from all other lamps, m. An axis along which the
/// lamp keeps its place has a box without length.
struct AllowedPlace {
  int lamp = 0;  ///< index into Scene::lamps
  Eigen::Vector3d low = Eigen::Vector3d::Zero(), high = Eigen::Vector3d::Zero();
  double apart = 0.0;  ///< between middles, >= 0
};

/// Boxes and distances of lamps that are moved together.
struct AllowedPlaces {
  std::vector<AllowedPlace> moved{};     ///< a lamp each
  std::vector<Eigen::Vector3d> fixed{};  ///< m, places of lamps that stay
};

/// Places of the moved lamps in a scene, 3 x lamps, m.
Eigen::Matrix3Xd places_of(const Scene& scene, const AllowedPlaces& allowed);

/// Distances within which places keep their limits, m: the last digit of written places.
inline constexpr double place_tolerance = 1e-6;

/// True if all lamps are in their boxes, and each two as far apart as the larger of their
/// distances, within place_tolerance. `places` are 3 x lamps, m.
bool allows(const AllowedPlaces& allowed, const Eigen::Matrix3Xd& places);

/// Allowed places near the given ones: the nearest in the boxes, where each two lamps that are too
/// close are pushed apart by half of what they lack each until none are (projection onto one
/// constraint after the other; Bregman 1965). Empty if that does not end, since too many lamps
/// share a box.
std::optional<Eigen::Matrix3Xd> nearest_allowed(const AllowedPlaces& allowed,
                                                const Eigen::Matrix3Xd& places);

}  // namespace lightwell
