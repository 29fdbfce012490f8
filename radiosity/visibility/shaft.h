#pragma once

#include <vector>

#include "mesh/geometry/box_tree.h"
#include "mesh/patches/patch_outline.h"
#include "radiosity/visibility/occluders.h"
#include "scene/surface_point.h"

namespace lightwell {

/// One end of a shaft: a planar patch, or a point of a surface.
struct ShaftEnd {
  std::vector<Eigen::Vector3d> corners{};  ///< of all parts; one for a point
  std::vector<ConvexPolygon> parts{};      ///< tile the patch, counter-clockwise; none for a point
  HalfSpace plane{};                       ///< what the end can see, of unit normal
  Eigen::AlignedBox3d box{};
  int sheet = -1;  ///< of Occluders; -1: in free space
};

/// What may stand between two ends.
struct Between {
  std::vector<int> pieces{};   ///< of Occluders::pieces
  bool may_be_sphere = false;  ///< or a polygon with holes: both are left to rays

  bool is_nothing() const { return pieces.empty() && !may_be_sphere; }
};

/// Shaft culling (Haines & Wallace 1994): which facets may stand between two patches, or between a
/// point and a patch. Never leaves out one that does.
///
/// A facet can hide nothing unless it meets the box about both ends, reaches before both ends'
/// planes, has the ends on different sides of its own plane, and meets their convex hull, whose
/// faces run through an edge of one end and a corner of the other. What comes no further than
/// Occluders::tolerance counts as outside, so facets that touch the ends, lie in their planes or
/// share their edges are not found.
class Shafts {
 public:
  explicit Shafts(const PatchMesh& mesh);

  const Occluders& occluders() const { return occluders_; }

  /// Empty (no parts) for an outline that is no polygon or crosses itself.
  /// `facet`: of the patch; -1: of several.
  ShaftEnd end(const PatchOutline& outline, int facet) const;
  /// `facet`: on which the point lies; -1: in free space.
  ShaftEnd end(const SurfacePoint& at) const;

  /// Whether a facet of another sheet lies on the end, face to face: it hides what it covers, which
  /// no shaft shows.
  bool is_covered(const ShaftEnd& end) const;

  /// Fills `between`; pieces in ascending order.
  void find(const ShaftEnd& a, const ShaftEnd& b, Between& between) const;

 private:
  /// Some pieces, to be found by their boxes.
  struct Group {
    std::vector<int> pieces{};
    BoxTree tree{{}};
  };
  void find_in(const Group& group, const ShaftEnd& a, const ShaftEnd& b, Between& between) const;

  Occluders occluders_;
  Group inner_, outer_;  // pieces with parts of the mesh on both sides, and the others
};

}  // namespace lightwell
