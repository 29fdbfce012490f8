#pragma once

#include "mesh/patches/patch_mesh.h"
#include "radiosity/solution/solution.h"
#include "scene/scene.h"

namespace lightwell {

/// Surfaces without light in rooms that a person could stand in.
struct DarkRooms {
  double area = 0.0;   ///< m^2, one side
  double share = 0.0;  ///< of the fronts that reflect
  int surface = -1;    ///< with most of the area; -1: there is none
};

/// Finds sides that reflect, get no light at all, and face a room. A side faces a room if
///
/// - nothing is in front of it for `clearance`, so that undersides of furniture, the floor below it
///   and the inside of walls do not count;
/// - at least three quarters of its hemisphere show surfaces and not the void or black backs, so
/// that
///   the outside of a house does not count;
/// - the place half of `clearance` in front of it is as wide in all directions along the side, so
/// that
///   a shaft between two walls does not count, though it is long.
///
/// `clearance` is 1.2 m, or a quarter of the diagonal of a scene that is smaller than a room. Areas
/// are estimated from at most 4096 of the dark elements.
DarkRooms find_dark_rooms(const Scene& scene, const PatchMesh& mesh,
                          const RadiositySolution& solution);

}  // namespace lightwell
