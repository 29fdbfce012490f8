#pragma once

#include <Eigen/Geometry>

#include "scene/io/mitsuba/mitsuba_tree.h"

namespace lightwell {

/// The transformation a <transform> stands for: its translate, rotate (degrees about an axis),
/// scale, lookat and matrix (4 x 4 or 3 x 3, row by row) elements, the first applied first. Throws
/// InputError naming file and line unless it is finite, affine and not zero; it may flatten.
Eigen::Affine3d read_mitsuba_transform(const MitsubaNode& node);

/// The same for the property "to_world" of `owner`; the identity without one.
Eigen::Affine3d read_to_world(const MitsubaNode& owner);

/// A <point> or <vector>: x, y and z (0 if missing), or value="x, y, z".
Eigen::Vector3d read_mitsuba_point(const MitsubaNode& node);

}  // namespace lightwell
