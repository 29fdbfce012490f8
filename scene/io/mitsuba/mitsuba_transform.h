#pragma once

#include <Eigen/Geometry>

#include "scene/io/mitsuba/mitsuba_tree.h"

namespace lightwell {

/// The transformation of a <transform>: the product of its translate, rotate (degrees about an
/// axis), scale, lookat and matrix (4 x 4 or 3 x 3, row by row) elements, the first applied first.
/// The result may flatten. Throws InputError naming file and line unless it is finite, affine and
/// not zero.
Eigen::Affine3d read_mitsuba_transform(const MitsubaNode& node);

/// The transformation in the property "to_world" of `owner`; the identity without the property.
Eigen::Affine3d read_to_world(const MitsubaNode& owner);

/// Rotation or mirroring of a sky, by the property "to_world" of `owner` without its translation
/// and size. Throws InputError naming file and line for other transformations.
Eigen::Matrix3d read_turn(const MitsubaNode& owner);

/// Coordinates of a <point> or <vector>: x, y and z (0 if missing), or value="x, y, z".
Eigen::Vector3d read_mitsuba_point(const MitsubaNode& node);

}  // namespace lightwell
