#pragma once

#include <array>
#include <vector>

#include "mesh/contacts/contact_graph.h"

namespace lightwell {

/// The elements and patches of one facet's front.
struct FacetMesh {
  /// An element's edge that no other element of this facet shares, or that lies on a contact line;
  /// in the element's direction.
  struct BorderEdge {
    std::array<int, 2> vertex{};
    std::array<int, 2> point{};  ///< the same as numbers of ContactGraph::points
  };
  std::vector<Eigen::Vector3d> position{};    ///< per vertex
  std::vector<std::array<int, 4>> corners{};  ///< counter-clockwise; [3] is -1 for a triangle
  std::vector<int> first_element{0};          ///< patches + 1
  std::vector<BorderEdge> border{};
  /// Contact lines had to be left out: they lie so close together that rounding folds elements up.
  bool is_flawed = false;
  bool lacks_creases = false;  ///< the same of creases
  bool has_cut_lines = false;  ///< lines cross, where vertices had to be added

  int patch_count() const { return static_cast<int>(first_element.size()) - 1; }
};

/// Cuts a facet into elements and patches: one element if it is small; a grid of quadrilaterals if
/// it has four sides; else a constrained Delaunay triangulation of boundary, contact lines and a
/// grid of inner points, paired into quadrilaterals. Vertices on contact lines are split, one for
/// each side; on creases both sides share them. Empty if the elements do not add up to the polygon
/// (its boundary crosses itself).
FacetMesh mesh_facet(const FacetPlane& plane, const FacetOutline& outline,
                     const std::vector<Eigen::Vector3d>& points, const CutSize& size);

/// Smallest sine among the angles of a counter-clockwise quadrilateral: 1 for a rectangle, <= 0
/// unless convex.
double quad_quality(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& c,
                    const Eigen::Vector2d& d);

}  // namespace lightwell
