#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "mesh/patches/patch_mesh.h"
#include "radiosity/visibility/convex_polygon.h"

namespace lightwell {

/// A convex piece of a sheet (see Occluders).
struct Occluder {
  ConvexPolygon polygon{};  ///< counter-clockwise about the normal
  HalfSpace plane{};        ///< unit normal
  Eigen::AlignedBox3d box{};
  int sheet = 0;           ///< as in Occluders::sheet_of_facet
  bool has_holes = false;  ///< a texture cuts holes into some facet of the sheet
};

/// The polygons of a mesh as occluders. Facets that lie in one plane, face the same way and share
/// edges form one *sheet*, such as the squares of a wall. A sheet is split into the convex pieces
/// that convex_pieces() finds. Pieces overlap only where elements overlap. Every polygon blocks
/// from both sides.
struct Occluders {
  explicit Occluders(const PatchMesh& mesh);

  std::vector<Occluder> pieces{};
  std::vector<int> sheet_of_facet{};  ///< per scene-wide facet; -1 for round shapes
  std::vector<RoundShape> round_shapes{};
  /// Distance that counts as touching, m: 1e-7 of the diagonal of the mesh's bounds, the resolution
  /// of shadow rays in single precision.
  double tolerance = 0.0;
};

}  // namespace lightwell
