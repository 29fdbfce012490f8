#pragma once

#include <Eigen/Geometry>
#include <array>
#include <set>
#include <vector>

#include "mesh/contacts/contact_graph.h"
#include "mesh/geometry/triangulate.h"

namespace lightwell {

/// The lines of an outline, over points numbered within the facet.
struct LocalLines {
  std::vector<int> point{};           ///< number in ContactGraph::points()
  std::vector<Eigen::Vector2d> xy{};  ///< the same in the facet's frame
  std::vector<std::array<int, 2>> boundary{};
  std::vector<std::array<int, 2>> all{};   ///< boundary, contacts, creases
  int hard_count = 0;                      ///< number of entries of `all` before the creases
  std::set<std::array<int, 2>> creases{};  ///< the creases, lower number first
  Eigen::AlignedBox2d box{};
};

/// A facet's constrained Delaunay triangulation: of its lines, of a grid of inner points, and of
/// points that let triangles grow from finely divided lines to the size of the others (see
/// graded_points()).
struct FacetTriangulation {
  LocalLines lines{};  ///< the lines' points are the first of the triangulation's
  PlanarTriangulation triangulation{};
  std::vector<char> inside{};  ///< per triangle, 1 if it belongs to the facet
};

/// Triangulates a facet. The outline's numbers are indices into `points`.
FacetTriangulation triangulate_facet(const FacetPlane& plane, const FacetOutline& outline,
                                     const std::vector<Eigen::Vector3d>& points,
                                     const FacetSize& size);

}  // namespace lightwell
