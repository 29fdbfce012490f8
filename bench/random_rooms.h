#pragma once

#include <cstdint>
#include <vector>

#include "scene/scene.h"

namespace lightwell {

/// A place of a random room at which light is compared.
struct RoomPlace {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< on a surface, metres
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();   ///< unit, into the room
  double gap = 0.0;  ///< width of the gap that the place lies in, metres; 0: no gap
};

struct RandomRoom {
  Scene scene{};
  std::vector<RoomPlace> places{};
};

/// A closed room with boxes, of random size (0.1 to 30 m), reflectances (0.1 to 0.85), lamps and
/// turn, and `places` points, uniform over half of the surfaces' area and over the surfaces.
RandomRoom random_room(std::uint64_t number, int places);

/// A furnished room with gaps of 0.2 to 10 mm: a monitor and books above a desk, a cupboard before
/// a wall, boxes above a floor and side by side; turned at random. Half of the `places` lie in
/// gaps.
RandomRoom gap_room(std::uint64_t number, int places);

}  // namespace lightwell
