#pragma once

#include <Eigen/Core>
#include <array>
#include <string>
#include <vector>

#include "scene/scene.h"

namespace lightwell {

/// Tolerance, relative to a polygon's size, of the distance of vertices from its plane, and least
/// width of a polygon with an area. Coordinates with six decimals satisfy the tolerance; its effect
/// on a radiosity mesh is invisible.
inline constexpr double flatness = 1e-6;

using Loop = std::vector<Eigen::Vector3d>;

/// A polygon of a file before its conversion to a Facet.
struct Polygon {
  Loop boundary{};
  std::vector<Loop> holes{};
};

/// Describes the first fault of a polygon ("has edges 1 and 3 that cross or touch"); empty for a
/// valid one. Vertices and edges count from 1; edge i starts at vertex i. A non-planar polygon is
/// tested in projection along its normal.
std::string fault(const Polygon& polygon);

/// Largest distance of a vertex, holes included, from the boundary's plane (Newell's normal through
/// the centroid), divided by the boundary's size.
double deviation_from_plane(const Polygon& polygon);

/// Vector area of a loop: half the sum of the cross products of its edges, that is area times
/// normal (Newell).
Eigen::Vector3d area_vector(const Loop& loop);

/// Twice the largest distance of a vertex from the vertices' mean.
double size_of(const Loop& loop);

/// True if a loop is thinner than `flatness` of its size.
bool is_thin(const Loop& loop);

/// Triangulates a polygon without holes by ear clipping (Meisters 1975) in projection along its
/// normal; triangles keep the orientation. A quadrilateral is cut along v0-v2 if that diagonal lies
/// inside. The loop may touch itself (a hole joined by a bridge). Empty if the loop crosses itself.
std::vector<std::array<int, 3>> split_into_triangles(const Loop& loop);

}  // namespace lightwell
