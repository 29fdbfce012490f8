#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <span>
#include <vector>

#include "scene/scene.h"

namespace lightwell {

/// The maps of a facet, which may not change inside a merged polygon.
struct FacetMaps {
  int uv = -1;      ///< Facet::uv_map
  int normal = -1;  ///< Facet::normal_map

  bool operator==(const FacetMaps& other) const = default;
};

/// The polygons of one surface over welded points, in flat arrays, because a surface may have
/// millions.
struct FacetLoops {
  std::vector<int> corner{};  ///< points, loop after loop; a facet's first loop is its boundary
  std::vector<int> loop_begin{0};  ///< loop l is [loop_begin[l], loop_begin[l + 1]) of corner
  /// Facet f is [facet_begin[f], facet_begin[f + 1]) of the loops.
  std::vector<int> facet_begin{0};
  std::vector<FacetMaps> maps{};  ///< by facet

  int count() const { return static_cast<int>(facet_begin.size()) - 1; }
  std::span<const int> loop(int l) const {
    return std::span(corner).subspan(static_cast<std::size_t>(loop_begin[l]),
                                     static_cast<std::size_t>(loop_begin[l + 1] - loop_begin[l]));
  }
  void add_loop(std::span<const int> points) {
    corner.insert(corner.end(), points.begin(), points.end());
    loop_begin.push_back(static_cast<int>(corner.size()));
  }
  /// Makes the loops added since the last facet one facet.
  void end_facet(const FacetMaps& maps_of_facet = {}) {
    facet_begin.push_back(static_cast<int>(loop_begin.size()) - 1);
    maps.push_back(maps_of_facet);
  }
  /// Reverses the loops of a facet; the first corner of each stays first.
  void turn_over(int facet);

  /// Calls visit(from, to) with the points of each edge of the facet, in its direction.
  template <class Visit>
  void for_each_edge(int facet, Visit&& visit) const {
    for (int l = facet_begin[facet]; l < facet_begin[facet + 1]; ++l) {
      const auto points = loop(l);
      for (std::size_t i = 0; i < points.size(); ++i) {
        visit(points[i], points[i + 1 < points.size() ? i + 1 : 0]);
      }
    }
  }
};

/// The area vector of a facet, m^2 along the normal: half the sum of the cross products of its
/// edges, holes subtracted.
Eigen::Vector3d area_vector(const FacetLoops& facets, int facet,
                            const std::vector<Eigen::Vector3d>& points);

/// The use of an edge by a facet: from the edge's lower to its higher point (`forward`) or the
/// other way.
struct EdgeUse {
  int low = 0, high = 0;  ///< points
  int facet = 0;
  bool forward = true;

  bool same_edge(const EdgeUse& other) const { return low == other.low && high == other.high; }
};

/// Returns the edges of all facets, sorted by their points, then by facet: the uses of one edge are
/// consecutive.
std::vector<EdgeUse> edge_uses(const FacetLoops& facets);

/// Calls visit(uses) with all uses of each edge.
template <class Visit>
void for_each_edge_group(const std::vector<EdgeUse>& uses, Visit&& visit) {
  for (std::size_t begin = 0, end = 0; begin < uses.size(); begin = end) {
    while (end < uses.size() && uses[end].same_edge(uses[begin])) ++end;
    visit(std::span(uses).subspan(begin, end - begin));
  }
}

/// Returns per facet 1 if an earlier facet has the same edges and faces the same way (any way, if
/// `either_facing`).
std::vector<char> find_duplicates(const FacetLoops& facets,
                                  const std::vector<Eigen::Vector3d>& points, bool either_facing);

/// Returns per facet 1 if it has to be turned over so that neighbours face alike; see
/// merge_planar_regions().
std::vector<char> find_reversed(const FacetLoops& facets,
                                const std::vector<Eigen::Vector3d>& points);

}  // namespace lightwell
