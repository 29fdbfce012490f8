#pragma once

#include <Eigen/Geometry>

#include "scene/io/pov/pov_value.h"

namespace lightwell {

/// Puts a transformation (translate, rotate, scale, matrix, or a block `transform`) after `all`,
/// where one is next in the block. False, with nothing passed, if none is next. Angles turn x
/// towards y, y towards z and z towards x. Throws InputError for a transformation without values.
bool take_pov_transform(PovCursor& cursor, Eigen::Affine3d& all);

/// Transformation from the left-handed axes of scene texts to those of a Scene: z is turned around.
Eigen::Affine3d from_pov_axes();

}  // namespace lightwell
