#pragma once

#include <optional>
#include <vector>

#include "mesh/elements/element_caster.h"
#include "radiosity/gather/final_gather.h"

namespace lightwell {

/// A gather point for every vertex, made on demand: 2 % of the way from the vertex to the centre of
/// one of its elements, or more (see inset_share), so that the point lies on no edge, with the
/// facet and the normal of that element. On round shapes the point lies on the surface. If the
/// vertex is shared by facets that meet smoothly, the point lies as far above them as well, with
/// their common normal and no facet. Keeps a reference to the mesh.
class VertexGatherPoints {
 public:
  explicit VertexGatherPoints(const PatchMesh& mesh);
  GatherPoint operator[](int vertex) const;
  /// The point of a vertex on its element's facet, also where facets meet smoothly.
  GatherPoint on_facet(int vertex) const;
  /// The common normal of facets that meet smoothly at the vertex; empty elsewhere.
  std::optional<Eigen::Vector3d> common_normal(int vertex) const;
  /// The centre of the element that the point of the vertex lies in; the vertex itself without one.
  Eigen::Vector3d center(int vertex) const;
  /// The element that the point of the vertex lies in; -1: none.
  int element(int vertex) const { return element_[vertex]; }

 private:
  const PatchMesh& mesh_;
  std::vector<int> element_;  // vertex_elements()
};

/// The points of VertexGatherPoints for all vertices of a mesh.
std::vector<GatherPoint> vertex_gather_points(const PatchMesh& mesh);

/// The gather point of a vertex, a little way from `vertex` towards the centre of an element. The
/// point is moved further inside, to as far from the vertex as a gap is wide, if another surface is
/// above the point, nearer than 0.3 of `reach` (see gap_reach): light falls off steeply where a gap
/// begins, and light at its brink would be interpolated far inside.
GatherPoint moved_into_gap(const ElementCaster& caster, const Eigen::Vector3d& vertex, double reach,
                           const GatherPoint& point);

/// The length that gaps at a vertex are compared with, metres: the way from `vertex` to the centre
/// of an element of the caster's mesh, but little more than the element is wide. A slat of a blind
/// is long beside the way to the next slat, and light still changes across it: a point that is
/// moved as far as that would show the sun beyond the shadow's edge.
double gap_reach(const PatchMesh& mesh, int element, const Eigen::Vector3d& vertex);

/// The gather points of all vertices of a caster's mesh. They are those of VertexGatherPoints,
/// except beside other surfaces:
/// - in a gap, they are moved_into_gap();
/// - where facets meet smoothly, they lie at most half as high as whatever is above, as in the
///   wedge between a surface and another that passes through it. A higher point might lie within
///   the body that the other surface bounds, whose light has nothing to do with that of the vertex.
/// Keeps a reference to `caster`.
GatherPoints vertex_points(const ElementCaster& caster);

}  // namespace lightwell
