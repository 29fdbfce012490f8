#pragma once

#include <Eigen/Geometry>
#include <filesystem>

#include "scene/bands.h"
#include "scene/io/radiance/text/radiance_primitive.h"

namespace lightwell {

/// Mean factor, r, g and b >= 0, of a brightfunc or colorfunc that depends on the position, such as
/// the grain of wood: over 2048 points of `box`, coordinates of the scene, rounded to three digits.
/// Throws InputError for patterns of other types, files that are missing, and formulas that use
/// more than position, normal and arguments.
Spectrum mean_over(const RadiancePrimitive& pattern, const Eigen::AlignedBox3d& box,
                   const std::filesystem::path& folder);

/// Bounds of a surface; empty for other primitives.
Eigen::AlignedBox3d radiance_bounds(const RadiancePrimitive& surface);

}  // namespace lightwell
