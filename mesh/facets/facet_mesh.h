#pragma once

#include <array>
#include <vector>

#include "mesh/contacts/contact_graph.h"

namespace lightwell {

/// The elements and patches of one facet's front.
struct FacetMesh {
  /// An edge of an element that no other element of the facet shares, or that lies on a contact
  /// line; directed as in the element.
  struct BorderEdge {
    std::array<int, 2> vertex{};
    /// The same as numbers of ContactGraph::points(); -1: not among these.
    std::array<int, 2> point{};
  };
  std::vector<Eigen::Vector3d> position{};    ///< per vertex
  std::vector<std::array<int, 4>> corners{};  ///< counter-clockwise; [3] is -1 for a triangle
  std::vector<int> first_element{0};          ///< patches + 1
  std::vector<BorderEdge> border{};
  /// True if contact lines were left out because they lie so close together that rounding folds
  /// elements up.
  bool is_flawed = false;
  bool lacks_creases = false;  ///< true if creases were left out for that reason
  bool has_cut_lines = false;  ///< true if vertices were added where lines cross
  /// True if the polygon crosses or overlaps itself: the elements cover what its boundary winds
  /// round and no hole does.
  bool crosses_itself = false;

  int patch_count() const { return static_cast<int>(first_element.size()) - 1; }
};

/// Cuts a facet into elements and patches:
/// - one element if the facet is small;
/// - a grid of quadrilaterals if the facet has four sides and even sizes;
/// - else a constrained Delaunay triangulation of boundary, contact lines and a grid of inner
///   points (corners of graded cells for sizes that grow), paired into quadrilaterals.
///
/// Vertices on contact lines are split, one for each side; on creases both sides share a vertex.
/// The outline's numbers are indices into `points`. Returns an empty mesh if the polygon has no
/// area.
FacetMesh mesh_facet(const FacetPlane& plane, const FacetOutline& outline,
                     const std::vector<Eigen::Vector3d>& points, const FacetSize& size);

/// The smallest sine of the angles of a counter-clockwise quadrilateral (its scaled Jacobian): 1
/// for a rectangle, <= 0 for a quadrilateral that is not convex.
double quad_quality(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& c,
                    const Eigen::Vector2d& d);

}  // namespace lightwell
