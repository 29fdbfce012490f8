#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

namespace lightwell {

/// A loop of vertices in space.
using Loop = std::vector<Eigen::Vector3d>;

/// Form factor from a differential element at `point` with unit normal `normal` to an unoccluded
/// polygon: Lambert's contour formula F = 1/(2 pi) sum_k Gamma_k . n (Baum, Rushmeier & Winget
/// 1989, eq. 5) after clipping to the element's horizon. The first loop is the boundary, further
/// loops are holes of opposite winding. Positive when the loop runs counter-clockwise seen from the
/// element, negative when clockwise. |F| <= 1. Relative error about 1e-12; 0 for a polygon that
/// rises above the horizon by less than 1e-9 of its distance, as one in the plane of the point.
double point_to_polygon(const Eigen::Vector3d& point, const Eigen::Vector3d& normal,
                        std::span<const Loop> loops);
/// Form factor to a polygon without holes; otherwise as above.
double point_to_polygon(const Eigen::Vector3d& point, const Eigen::Vector3d& normal,
                        std::span<const Eigen::Vector3d> loop);

/// Form factor from a differential element to an unoccluded sphere of `radius` about `center`,
/// clipped to the element's horizon (Snyder 1996, "Area light sources for real-time graphics",
/// spherical case). 0 for a point inside the sphere.
double point_to_sphere(const Eigen::Vector3d& point, const Eigen::Vector3d& normal,
                       const Eigen::Vector3d& center, double radius);

}  // namespace lightwell
