#pragma once

namespace lightwell {

/// Kinds of illuminance at the points of a calculation grid.
enum class GridQuantity {
  planar,          ///< of the grid's plane
  vertical,        ///< of upright planes that face one direction
  cylindrical,     ///< mean of the side of an upright cylinder (EN 12464-1)
  semicylindrical  ///< mean of the half of that side that faces one direction (EN 13201-3)
};

}  // namespace lightwell
