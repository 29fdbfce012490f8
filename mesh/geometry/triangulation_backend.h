#pragma once

#include "mesh/geometry/triangulate.h"

/// The library behind triangulate(): CGAL (triangulate_cgal.cpp) or CDT (triangulate_cdt.cpp), by
/// the CMake option LIGHTWELL_TRIANGULATION. One of the two sources is compiled.
namespace lightwell::backend {

/// The same as triangulate() but for the choice among cocircular points and the order of triangles
/// and of added points.
PlanarTriangulation delaunay(const std::vector<Eigen::Vector2d>& points,
                             const std::vector<std::array<int, 2>>& constraints);

/// 1: d lies inside the circle through a, b and c (counter-clockwise), 0: on it, -1: outside;
/// exact.
int side_of_circle(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& c,
                   const Eigen::Vector2d& d);

}  // namespace lightwell::backend
