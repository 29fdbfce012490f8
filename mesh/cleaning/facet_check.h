#pragma once

#include <cstdint>
#include <vector>

#include "scene/scene.h"

namespace lightwell {

/// Two facets of the scene with the same corners.
struct FacetPair {
  int first = 0, second = 0;  ///< scene-wide facet numbers, first < second
};

/// What about a scene's polygons would surprise whoever counts on closed, consistently turned
/// surfaces. Corners closer than 1e-7 of the scene's diagonal are one.
struct FacetCheck {
  std::int64_t open_edges = 0;          ///< belong to one facet only: light gets out there
  std::int64_t inconsistent_edges = 0;  ///< two facets run along them the same way: one is reversed
  std::vector<FacetPair> duplicates{};  ///< the second lies on the first and faces the same way
  std::vector<FacetPair> opposites{};   ///< the second lies on the first and faces the other way
};

/// Edges are compared whole: where facets meet along a part of an edge, it counts as open. Spheres
/// are closed and left out. A facet is in one pair of each kind at most, as the second; a facet
/// that is the second of a duplicate is in no other pair and has no part in the edges.
FacetCheck check_facets(const Scene& scene);

}  // namespace lightwell
