#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "mesh/geometry/box_tree.h"
#include "mesh/geometry/facet_plane.h"
#include "mesh/patches/patch_mesh.h"
#include "scene/scene.h"

namespace lightwell {

/// Which surface a place belongs to where polygons of several surfaces became one (see
/// join_surfaces): light is solved for on the joined polygon, and people ask by name.
class JoinedSurfaces {
 public:
  /// Of `before`, the surfaces numbered (rising) some of whose polygons were joined.
  JoinedSurfaces(const Scene& before, std::vector<int> numbers);

  /// The surface that has a point within a polygon of its own that faces along `front` (unit), to
  /// 1e-6 of the scene's diagonal; of several the first. -1: none.
  int surface_at(const Eigen::Vector3d& point, const Eigen::Vector3d& front) const;
  /// The surface that has a point (m) of an element: that of its patch, unless it was joined.
  int surface_of(const PatchMesh& mesh, int element, const Eigen::Vector3d& point) const;
  /// `joined` with the polygons that its surfaces had before: what to ask for a surface's shape.
  Scene apart(Scene joined) const;

 private:
  std::vector<int> numbers_;
  std::vector<Surface> surfaces_;   // as they were, of those numbers
  std::vector<FacetPlane> planes_;  // their polygons; `surface` counts in the two above
  double reach_ = 0.0;              // m
  BoxTree boxes_;                   // of the planes
};

/// Joins the polygons of different surfaces that lie in one plane, hang together over whole edges
/// and face alike, where the materials differ in name at most and both move alike: files that name
/// every polygon so need no more patches than those that do not. A joined polygon belongs to the
/// surface of its first part; surfaces may be left without any. What emits, is clear, or shows a
/// picture or normals of its own is left alone, and so is a polygon that fills a hole of another:
/// a switch in a wall stays an object of its own. Tolerances are those of merge_planar_regions().
/// Null, and the scene bit by bit as it was, where there is nothing to join.
std::shared_ptr<const JoinedSurfaces> join_surfaces(Scene& scene);

}  // namespace lightwell
