#include "mesh/cleaning/plane_regions.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <span>

#include "mesh/cleaning/region_outline.h"
#include "scene/parallel.h"

namespace lightwell {
namespace {

using Eigen::Vector3d;

const double least_cosine = std::cos(1.0 * std::numbers::pi / 180.0);
constexpr double needle_width = 4.0;  // tolerances; the normal of a thinner facet is meaningless
constexpr double rounding = 1e-9;     // of an area

class Regions {
 public:
  Regions(const FacetLoops& facets, const std::vector<Vector3d>& points, double tolerance)
      : facets_(facets),
        points_(points),
        tolerance_(tolerance),
        uses_(edge_uses(facets)),
        region_(static_cast<std::size_t>(facets.count()), -1) {
    index_edges();
    for (int f = 0; f < facets.count(); ++f) {
      const Vector3d vector = area_vector(facets, f, points);
      area_.push_back(vector.norm());
      normal_.push_back(area_.back() > 0.0 ? Vector3d(vector / area_.back()) : Vector3d::Zero());
      double length = 0.0;
      facets.for_each_edge(f, [&](int a, int b) { length += (points[a] - points[b]).norm(); });
      boundary_length_.push_back(length);
    }
    std::vector<int> order(region_.size());
    std::iota(order.begin(), order.end(), 0);
    std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return area_[a] > area_[b]; });
    for (const int seed : order) {
      if (region_[seed] < 0 && area_[seed] > 0.0) grow(seed);
    }
  }

  PlaneRegions take() {
    PlaneRegions regions;
    regions.outlines = outlines();
    regions.region = std::move(region_);
    return regions;
  }

 private:
  std::vector<std::vector<std::vector<int>>> outlines() const {
    std::vector<std::vector<RegionEdge>> edges(normal_of_region_.size());
    for_each_edge_group(uses_, [&](std::span<const EdgeUse> group) {
      const bool is_fan = group.size() > most_at_edge;  // no facets were joined over such an edge
      for (std::size_t i = 0; i < group.size(); ++i) {
        const int r = region_[group[i].facet];
        if (r < 0) continue;
        const auto is_inside = [&](const EdgeUse& other) {
          return region_[other.facet] == r && other.forward != group[i].forward;
        };
        if (!is_fan && std::any_of(group.begin(), group.end(), is_inside)) continue;
        const auto [low, high] = std::pair(group[i].low, group[i].high);
        edges[r].push_back(group[i].forward ? RegionEdge{low, high} : RegionEdge{high, low});
      }
    });
    std::vector<std::vector<std::vector<int>>> outlines(edges.size());
    parallel_for(static_cast<int>(edges.size()), 16, [&](int begin, int end) {
      for (int r = begin; r < end; ++r) {
        auto loops = region_loops(std::move(edges[r]), points_, normal_of_region_[r]);
        if (loops && keeps_area(r, *loops)) outlines[r] = std::move(*loops);
      }
    });
    return outlines;
  }

  // Fills the indices from facets to their uses of edges, and from a use to all uses of its edge.
  void index_edges() {
    group_begin_.resize(uses_.size());
    first_use_.assign(region_.size() + 1, 0);
    for (std::size_t begin = 0, end = 0; begin < uses_.size(); begin = end) {
      while (end < uses_.size() && uses_[end].same_edge(uses_[begin])) {
        group_begin_[end++] = static_cast<int>(begin);
      }
    }
    for (const EdgeUse& use : uses_) ++first_use_[use.facet + 1];
    std::partial_sum(first_use_.begin(), first_use_.end(), first_use_.begin());
    use_of_.resize(uses_.size());
    std::vector<int> next(first_use_.begin(), first_use_.end() - 1);
    for (std::size_t u = 0; u < uses_.size(); ++u) {
      use_of_[next[uses_[u].facet]++] = static_cast<int>(u);
    }
  }

  std::span<const EdgeUse> group_of(int use) const {
    const auto begin = static_cast<std::size_t>(group_begin_[use]);
    std::size_t end = begin;
    while (end < uses_.size() && end - begin <= most_at_edge &&
           uses_[end].same_edge(uses_[begin])) {
      ++end;
    }
    return std::span(uses_).subspan(begin, end - begin);
  }

  struct Growing {
    int number = 0;
    Vector3d normal, origin;
    Vector3d area_vector, moment;  // sums over facets: area vectors, and area times middle
    double area = 0.0, boundary_length = 0.0;  // of its facets
  };

  void grow(int seed) {
    if (!grow(seed, true)) grow(seed, false);
  }

  // Grows a region in the plane of the seed or, if `is_fitted`, in the plane fitted to all facets
  // so far, because the seed's own plane may lean by the tolerance over the seed's width. Returns
  // false if the facets do not lie in the fitted plane at the end.
  bool grow(int seed, bool is_fitted) {
    Growing region{.number = static_cast<int>(normal_of_region_.size()),
                   .normal = normal_[seed],
                   .origin = middle_of(seed),
                   .area_vector = Vector3d::Zero(),
                   .moment = Vector3d::Zero()};
    std::vector<int> members;
    const auto add = [&](int facet) {
      region.area += area_[facet];
      region.boundary_length += boundary_length_[facet];
      region.area_vector += area_[facet] * normal_[facet];
      region.moment += area_[facet] * middle_of(facet);
      if (is_fitted) {
        region.normal = region.area_vector.normalized();
        region.origin = region.moment / region.area;
      }
      region_[facet] = region.number;
      members.push_back(facet);
    };
    add(seed);
    for (std::size_t m = 0; m < members.size(); ++m) {
      const int f = members[m];
      for (int k = first_use_[f]; k < first_use_[f + 1]; ++k) {
        const int next = across(use_of_[k], region);
        if (next >= 0) add(next);
      }
    }
    const bool is_flat = !is_fitted || std::all_of(members.begin(), members.end(),
                                                   [&](int f) { return lies_in(f, region); });
    if (!is_flat || members.size() == 1) {
      for (const int f : members) region_[f] = -1;
      return is_flat;
    }
    normal_of_region_.push_back(region.normal);
    area_of_region_.push_back(region.area);
    slack_of_region_.push_back(tolerance_ * region.boundary_length);
    return true;
  }

  Vector3d middle_of(int facet) const {
    const auto corners = facets_.loop(facets_.facet_begin[facet]);
    const Vector3d& first = points_[corners[0]];
    Vector3d sum = Vector3d::Zero();
    for (const int v : corners) sum += points_[v] - first;
    return first + sum / static_cast<double>(corners.size());
  }

  // The one facet that continues the region's plane across an edge of the region; -1 if there is
  // none, or more than one.
  int across(int use, const Growing& region) const {
    const auto group = group_of(use);
    if (group.size() > most_at_edge) return -1;
    int found = -1;
    for (const EdgeUse& other : group) {
      if (other.facet == uses_[use].facet) {
        if (other.forward != uses_[use].forward) return -1;  // a bridge to a hole
        continue;
      }
      if (!lies_in(other.facet, region)) continue;
      if (other.forward == uses_[use].forward || found >= 0) return -1;
      found = other.facet;
    }
    if (found < 0 || region_[found] >= 0 || runs_along(found, region)) return -1;
    if (facets_.maps[found] != facets_.maps[uses_[use].facet]) return -1;
    return found;
  }

  bool lies_in(int facet, const Growing& region) const {
    const bool is_needle =
        4.0 * area_[facet] <= needle_width * tolerance_ * boundary_length_[facet];
    if (!is_needle && !(normal_[facet].dot(region.normal) >= least_cosine)) return false;
    bool is_near = true;
    facets_.for_each_edge(facet, [&](int a, int) {
      is_near = is_near && std::abs(region.normal.dot(points_[a] - region.origin)) <= tolerance_;
    });
    return is_near;
  }

  // True if the region passes an edge of the facet in the facet's direction, which means that the
  // two overlap.
  bool runs_along(int facet, const Growing& region) const {
    for (int k = first_use_[facet]; k < first_use_[facet + 1]; ++k) {
      const EdgeUse& mine = uses_[use_of_[k]];
      for (const EdgeUse& other : group_of(use_of_[k])) {
        if (other.facet != facet && region_[other.facet] == region.number &&
            other.forward == mine.forward) {
          return true;
        }
      }
    }
    return false;
  }

  bool keeps_area(int region, const std::vector<std::vector<int>>& loops) const {
    FacetLoops whole;
    for (const auto& loop : loops) whole.add_loop(loop);
    whole.end_facet();
    const double area = area_vector(whole, 0, points_).norm();
    return std::abs(area - area_of_region_[region]) <= slack_of_region_[region] + rounding * area;
  }

  // Facets; more are a fan, whose sides are ambiguous.
  static constexpr std::size_t most_at_edge = 8;

  const FacetLoops& facets_;
  const std::vector<Vector3d>& points_;
  double tolerance_;
  std::vector<EdgeUse> uses_;
  std::vector<int> group_begin_;         // per use, in uses_
  std::vector<int> first_use_, use_of_;  // per facet, its uses
  std::vector<int> region_;
  std::vector<double> area_, boundary_length_;
  std::vector<Vector3d> normal_;
  std::vector<Vector3d> normal_of_region_;
  std::vector<double> area_of_region_, slack_of_region_;
};

}  // namespace

PlaneRegions find_plane_regions(const FacetLoops& facets, const std::vector<Vector3d>& points,
                                double tolerance) {
  return Regions(facets, points, tolerance).take();
}

}  // namespace lightwell
