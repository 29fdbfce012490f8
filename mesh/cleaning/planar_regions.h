#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "scene/scene.h"

namespace lightwell {

class JoinedSurfaces;

/// What merge_planar_regions() found and did.
struct CleanUpReport {
  std::int64_t facets_before = 0, facets_after = 0;  ///< spheres count as one
  std::int64_t welded_vertices = 0;  ///< joined with another vertex of their surface
  std::int64_t degenerate = 0;       ///< facets dropped for having no area
  std::int64_t duplicates = 0;       ///< facets dropped for lying on an equal one
  std::int64_t flipped = 0;          ///< facets turned over to face as their neighbours do
  std::int64_t merged = 0;           ///< facets that became part of a larger polygon
  std::int64_t hanging = 0;  ///< vertices found inside an edge of another facet of their surface
  std::int64_t joined = 0;   ///< polygons that went into one of another surface
  double area_before = 0.0, area_after = 0.0;  ///< of one side of all surfaces, m^2
  /// Which surface a place of those belongs to; null: there are none.
  std::shared_ptr<const JoinedSurfaces> names{};

  double area_change() const { return area_before > 0.0 ? area_after / area_before - 1.0 : 0.0; }
  bool is_clean() const {
    return welded_vertices + degenerate + duplicates + flipped + merged + joined == 0;
  }
};

/// One sentence for people: "142973 facets became 61204: ...".
std::string sentence(const CleanUpReport& report);

/// The same surfaces in fewer, cleaner polygons, as the commands that mesh for light use them.
/// Within each surface, in this order:
///
/// 1. corners closer than 1e-7 of the scene's diagonal become one (never the ends of one edge);
/// 2. facets without area are dropped: thinner than 1e-13, or smaller than 1e-9 of the diagonal;
/// 3. of facets with the same edges and the same facing the first stays; of facets back to back
///    too, where the material is alike on both sides;
/// 4. vertices that lie inside an edge of another facet (to 1e-7 of the diagonal) count as corners
/// of
///    that facet in what follows;
/// 5. facets that are connected over edges of exactly two facets are turned to face alike, as the
///    larger part of their area does. One-sided (Moebius) pieces and ties are left;
/// 6. facets in one plane, to 1e-7 of the diagonal, that are connected over whole edges become one
///    polygon, with holes: those on which a picture, where one lies on them, and normals that a
///    file gives at vertices go on alike. Where anything is uncertain (edges of overlapping facets,
///    boundaries that would cross) all stay;
/// 7. vertices inside straight edges of those polygons go, to 1e-7 of the diagonal, where no facet
///    left as it was has them.
///
/// Then polygons of surfaces that differ in name alone are joined too (see join_surfaces).
///
/// All this is the rounding of single-precision files: no point moves by more than t = 1e-7 of the
/// diagonal, so the area changes by less than t times the length of the facets' edges (measured: by
/// 3e-9 and less of the whole). A surface in which nothing is found stays bit by bit what it was;
/// facets that become no part of a polygon keep their corners, and the order is that of their first
/// part. O(n log n) in the number of corners.
Scene merge_planar_regions(const Scene& scene, CleanUpReport* report = nullptr);

}  // namespace lightwell
