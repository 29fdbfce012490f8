#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <span>
#include <vector>

#include "scene/scene.h"

namespace lightwell {

/// What goes on over a facet's plane and must not change across it.
struct FacetMaps {
  int uv = -1;      ///< see Facet::uv_map
  int normal = -1;  ///< see Facet::normal_map

  bool operator==(const FacetMaps& other) const = default;
};

/// The polygons of one surface over welded points, in flat arrays: a surface may have millions.
struct FacetLoops {
  std::vector<int> corner{};  ///< points, loop after loop; a facet's first loop is its boundary
  std::vector<int> loop_begin{0};  ///< loop l is [loop_begin[l], loop_begin[l + 1]) of corner
  std::vector<int> facet_begin{
      0};                         ///< facet f is [facet_begin[f], facet_begin[f + 1]) of the loops
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
  /// The loops added since the last facet are one.
  void end_facet(const FacetMaps& maps_of_facet = {}) {
    facet_begin.push_back(static_cast<int>(loop_begin.size()) - 1);
    maps.push_back(maps_of_facet);
  }
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

/// Half the sum of the edges' cross products, holes taken out: the area, along the normal.
Eigen::Vector3d area_vector(const FacetLoops& facets, int facet,
                            const std::vector<Eigen::Vector3d>& points);

/// An edge of a facet, from its lower to its higher point or the other way.
struct EdgeUse {
  int low = 0, high = 0;  ///< points
  int facet = 0;
  bool forward = true;

  bool same_edge(const EdgeUse& other) const { return low == other.low && high == other.high; }
};

/// All edges, sorted by their points, then facets: the uses of one edge lie side by side.
std::vector<EdgeUse> edge_uses(const FacetLoops& facets);

/// Calls visit(uses) with all uses of each edge.
template <class Visit>
void for_each_edge_group(const std::vector<EdgeUse>& uses, Visit&& visit) {
  for (std::size_t begin = 0, end = 0; begin < uses.size(); begin = end) {
    while (end < uses.size() && uses[end].same_edge(uses[begin])) ++end;
    visit(std::span(uses).subspan(begin, end - begin));
  }
}

/// Which facets have the edges of an earlier one and its facing (of either facing, if
/// `either_facing`), per facet.
std::vector<char> find_duplicates(const FacetLoops& facets,
                                  const std::vector<Eigen::Vector3d>& points, bool either_facing);

/// Which facets to turn over so that neighbours face alike, per facet; see merge_planar_regions.
std::vector<char> find_reversed(const FacetLoops& facets,
                                const std::vector<Eigen::Vector3d>& points);

}  // namespace lightwell
