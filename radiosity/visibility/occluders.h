#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "mesh/patches/patch_mesh.h"
#include "radiosity/visibility/convex_polygon.h"

namespace lightwell {

/// A convex piece of what stands in one plane.
struct Occluder {
  ConvexPolygon polygon{};  ///< counter-clockwise about the normal
  HalfSpace plane{};        ///< of unit normal
  Eigen::AlignedBox3d box{};
  int sheet = 0;           ///< see Occluders::sheet_of_facet
  bool has_holes = false;  ///< of a sheet that a picture cuts holes into
};

/// All polygons of a mesh as occluders. Facets that lie in one plane, face one way and share edges
/// are one *sheet*: the squares of a wall block together. A sheet is cut into as few convex pieces
/// as convex_pieces() finds; pieces do not overlap. Every polygon blocks from both sides.
struct Occluders {
  explicit Occluders(const PatchMesh& mesh);

  std::vector<Occluder> pieces{};
  std::vector<int> sheet_of_facet{};  ///< per scene-wide facet; -1 for spheres
  std::vector<Sphere> spheres{};
  /// What counts as touching, metres: 1e-7 of the diagonal of the mesh's bounds, which is what the
  /// single precision of shadow rays resolves.
  double tolerance = 0.0;
};

}  // namespace lightwell
