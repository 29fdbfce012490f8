#pragma once

#include <Eigen/Core>
#include <span>

#include "raytrace/light_regions.h"

namespace lightwell {

/// Epanechnikov's kernel over a disc of radius 1, K(s) = 2 / pi (1 - s^2), integrates to 1.
///
/// What a directed edge, in the plane of the disc and relative to its centre, cuts off: the
/// kernel's integral over the part of the disc that lies beyond it, between the directions of its
/// ends; negative if the edge runs clockwise. Counter-clockwise edges all around an area thus leave
/// 1 minus their sum of the kernel within it (Green's theorem).
double kernel_beyond(const Eigen::Vector2d& from, const Eigen::Vector2d& to);

/// The share of a disc's kernel that lies within a boundary, of which all edges that the disc
/// reaches over are given, seen along the disc's unit normal. At least 0.02: in the sharpest corner
/// worth the name some percent are left, and less is rounding.
double kernel_within(const Eigen::Vector3d& center, const Eigen::Vector3d& normal, double radius,
                     std::span<const LightRegions::Edge> edges);

}  // namespace lightwell
