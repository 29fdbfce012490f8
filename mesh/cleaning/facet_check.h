#pragma once

#include <cstdint>
#include <vector>

#include "scene/scene.h"

namespace lightwell {

/// Two facets of the scene with the same corners.
struct FacetPair {
  int first = 0, second = 0;  ///< scene-wide facet numbers, first < second
};

/// Defects of a scene's polygons for users of closed, consistently oriented surfaces. Corners
/// closer than 1e-7 of the scene's diagonal are one.
struct FacetCheck {
  std::int64_t open_edges = 0;  ///< edges of one facet only, through which light escapes
  /// Edges that two facets pass in the same direction: one is reversed.
  std::int64_t inconsistent_edges = 0;
  std::vector<FacetPair> duplicates{};  ///< the second lies on the first and faces the same way
  std::vector<FacetPair> opposites{};   ///< the second lies on the first and faces the other way
};

/// Checks the polygons of a scene; round shapes are left out. Edges are compared whole: where
/// facets meet along a part of an edge, the edge counts as open. A facet is the second of one pair
/// of each kind at most. A facet that is the second of a duplicate is in no other pair, and its
/// edges are not counted.
FacetCheck check_facets(const Scene& scene);

}  // namespace lightwell
