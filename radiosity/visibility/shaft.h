#pragma once

#include <vector>

#include "mesh/geometry/box_tree.h"
#include "mesh/patches/patch_outline.h"
#include "radiosity/visibility/occluders.h"
#include "scene/surface_point.h"

namespace lightwell {

/// One end of a shaft: a planar patch, or a point of a surface.
struct ShaftEnd {
  std::vector<Eigen::Vector3d> corners{};  ///< corners of all parts; a single one for a point
  /// Tile the patch, each counter-clockwise; none for a point.
  std::vector<ConvexPolygon> parts{};
  HalfSpace plane{};  ///< half-space that the end can see; unit normal
  Eigen::AlignedBox3d box{};
  /// Sheet of the end's facet (see Occluders); -1: in free space or on several facets.
  int sheet = -1;
};

/// Candidate occluders between two ends.
struct Between {
  std::vector<int> pieces{};  ///< indices of Occluders::pieces
  bool may_be_round = false;  ///< a round shape, or a polygon with holes, which only rays resolve

  bool is_nothing() const { return pieces.empty() && !may_be_round; }
};

/// Shaft culling (Haines & Wallace 1994): facets that may stand between two patches, or between a
/// point and a patch. Conservative: every facet that stands between is found.
///
/// A facet that hides something meets all these conditions:
///   - it meets the bounding box of both ends;
///   - it reaches before the planes of both ends;
///   - it has the ends on different sides of its own plane;
///   - it meets the convex hull of both ends, whose faces run through an edge of one end and a
///     corner of the other.
///
/// Whatever reaches in by no more than Occluders::tolerance counts as outside. Facets that touch
/// the ends, lie in the ends' planes or share the ends' edges are therefore not found.
class Shafts {
 public:
  explicit Shafts(const PatchMesh& mesh);

  const Occluders& occluders() const { return occluders_; }

  /// Shaft end of a patch on `facet` (-1: on several facets). Without parts if the outline is no
  /// polygon or crosses itself.
  ShaftEnd end(const PatchOutline& outline, int facet) const;
  /// Shaft end of a point on `facet` (-1: in free space).
  ShaftEnd end(const SurfacePoint& at) const;

  /// True if a facet of another sheet lies on the end, face to face. Such a facet hides what it
  /// covers, but is in no shaft.
  bool is_covered(const ShaftEnd& end) const;

  /// Fills `between` with the candidate occluders between a and b, pieces in ascending order.
  void find(const ShaftEnd& a, const ShaftEnd& b, Between& between) const;

 private:
  /// Pieces and the tree of their bounding boxes.
  struct Group {
    std::vector<int> pieces{};
    BoxTree tree{{}};
  };
  void find_in(const Group& group, const ShaftEnd& a, const ShaftEnd& b, Between& between) const;

  Occluders occluders_;
  // Pieces whose planes have parts of the mesh on both sides, and all other pieces.
  Group inner_, outer_;
};

}  // namespace lightwell
