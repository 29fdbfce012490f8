#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "scene/scene.h"

namespace lightwell {

class JoinedSurfaces;

/// The changes made by merge_planar_regions().
struct CleanUpReport {
  std::int64_t facets_before = 0,
               facets_after = 0;     ///< number of facets; a round shape counts as one
  std::int64_t welded_vertices = 0;  ///< vertices joined with another one of their surface
  std::int64_t degenerate = 0;       ///< facets dropped for having no area
  std::int64_t duplicates = 0;       ///< facets dropped for lying on an equal one
  std::int64_t flipped = 0;          ///< facets turned over to face as their neighbours do
  std::int64_t merged = 0;           ///< facets that became part of a larger polygon
  std::int64_t hanging = 0;  ///< vertices found inside an edge of another facet of their surface
  std::int64_t joined = 0;   ///< polygons joined with one of another surface
  double area_before = 0.0, area_after = 0.0;  ///< area of one side of all surfaces, m^2
  /// The surfaces to which the joined polygons belong; null if none were joined.
  std::shared_ptr<const JoinedSurfaces> names{};

  double area_change() const { return area_before > 0.0 ? area_after / area_before - 1.0 : 0.0; }
  bool is_clean() const {
    return welded_vertices + degenerate + duplicates + flipped + merged + joined == 0;
  }
};

/// The report as one sentence: "142973 facets became 61204: ...".
std::string sentence(const CleanUpReport& report);

/// Returns the scene with the same surfaces in fewer, cleaner polygons, as the commands that
/// compute light mesh them. Within each surface, with t = 1e-7 of the scene's diagonal:
///
/// 1. Corners closer than t are joined, except the two ends of one edge.
/// 2. Facets without area are dropped: thinner than 1e-13, or smaller than 1e-9 of the diagonal.
/// 3. Of facets with the same edges and the same facing the first stays; of facets back to back
///    too, where the material is alike on both sides.
/// 4. A vertex that lies inside an edge of another facet, to t, counts as a corner of that facet in
///    the following steps.
/// 5. Facets connected over edges of exactly two facets are turned to face alike, as the larger
///    part of their area does. One-sided (Moebius) pieces and ties stay.
/// 6. Facets in one plane, to t, that are connected over whole edges become one polygon with holes.
///    A picture and normals given at vertices must continue from facet to facet. Facets stay where
///    anything is uncertain: edges of overlapping facets, or boundaries that would cross.
/// 7. Vertices inside straight edges of these polygons, to t, are dropped unless an unchanged facet
///    has them.
///
/// Then, of surfaces that differ in name alone, polygons that lie on an equal one are dropped, and
/// polygons of one plane are joined. At last materials whose power the file states get the emission
/// that sends it from the area that is left.
///
/// The tolerance is the rounding of single-precision files. No point moves by more than t, so the
/// area changes by less than t times the length of the facets' edges (measured: at most 3e-9 of the
/// whole). A surface without findings stays the same bit for bit. Facets that become no part of a
/// polygon keep their corners, and a polygon stands in the place of its first part. O(n log n) in
/// the number of corners.
Scene merge_planar_regions(const Scene& scene, CleanUpReport* report = nullptr);

}  // namespace lightwell
