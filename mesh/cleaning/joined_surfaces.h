#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <vector>

#include "mesh/patches/patch_mesh.h"
#include "scene/scene.h"

namespace lightwell {

/// The surfaces to which places belong where polygons of several surfaces became one (see
/// join_surfaces()). Light is solved for on the joined polygon, while reports and the window name
/// the original surfaces.
class JoinedSurfaces {
 public:
  /// `numbers`, ascending, are the surfaces of `before` of which some polygons were joined.
  JoinedSurfaces(const Scene& before, std::vector<int> numbers);

  /// The surface that has a polygon which contains `point` (m) and faces along `front` (unit), to
  /// 1e-6 of the scene's diagonal; the first of several; -1: none.
  int surface_at(const Eigen::Vector3d& point, const Eigen::Vector3d& front) const;
  /// The surface that has a point (m) of an element: that of the element's patch, unless the
  /// surface was joined.
  int surface_of(const PatchMesh& mesh, int element, const Eigen::Vector3d& point) const;
  /// Returns `joined` with the polygons that its surfaces had before joining: the true shape of
  /// each surface.
  Scene apart(Scene joined) const;

 private:
  struct Planes;
  std::vector<int> numbers_;
  std::vector<Surface> surfaces_;  // as they were before, in the order of numbers_
  double reach_ = 0.0;             // m, tolerance of surface_at()
  std::shared_ptr<const Planes> planes_;
};

/// Drops polygons that lie on an equal one of another surface and face the same way, where the
/// materials of both differ in name at most, and both move alike; the first stays. No polygon of an
/// emitter or of a clear or textured material is dropped. Surfaces may be left without any polygon.
/// Returns the number of polygons dropped.
std::int64_t drop_shared_duplicates(Scene& scene);

/// Joins polygons of different surfaces, so that files that give every polygon a name of its own
/// need no more patches than others. Polygons are joined if they
/// - lie in one plane, are connected over whole edges and face alike;
/// - have materials that differ in name at most, and move alike;
/// - neither emit, nor are clear, nor show a picture or normals of their own;
/// - do not fill a hole of another polygon: a switch in a wall stays an object of its own.
///
/// A joined polygon belongs to the surface of its first part; surfaces may be left without any
/// polygon. Tolerances are those of merge_planar_regions(). Returns null and leaves the scene
/// unchanged bit for bit where there is nothing to join.
std::shared_ptr<const JoinedSurfaces> join_surfaces(Scene& scene);

}  // namespace lightwell
