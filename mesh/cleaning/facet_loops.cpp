#include "mesh/cleaning/facet_loops.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>
#include <utility>

#include "scene/sampling.h"

namespace lightwell {
namespace {

using Eigen::Vector3d;
using EdgeEnds = std::pair<int, int>;  // lower point, higher point

std::vector<EdgeEnds> sorted_edges(const FacetLoops& facets, int facet) {
  std::vector<EdgeEnds> edges;
  facets.for_each_edge(facet, [&](int a, int b) { edges.push_back(std::minmax(a, b)); });
  std::sort(edges.begin(), edges.end());
  return edges;
}

std::uint64_t key_of(const std::vector<EdgeEnds>& edges) {
  std::uint64_t key = edges.size();
  for (const auto& [a, b] : edges) {
    key = random_key(key, static_cast<std::uint64_t>(a), static_cast<std::uint64_t>(b));
  }
  return key;
}

// Disjoint sets of facets joined over edges (union-find); each facet knows whether it faces as its
// root does.
class FacingGroups {
 public:
  explicit FacingGroups(int count)
      : parent_(static_cast<std::size_t>(count)), turned_(parent_.size()), mixed_(parent_.size()) {
    std::iota(parent_.begin(), parent_.end(), 0);
  }
  struct Membership {
    int root = 0;
    bool turned = false;
  };
  Membership find(int i) {
    bool turned = false;
    int root = i;
    while (parent_[root] != root) {
      turned ^= turned_[root] != 0;
      root = parent_[root];
    }
    // Path compression: everything on the way then hangs on the root.
    for (bool rest = turned; parent_[i] != i;) {
      const int next = parent_[i];
      const bool step = turned_[i] != 0;
      parent_[i] = root;
      turned_[i] = rest ? 1 : 0;
      rest ^= step;
      i = next;
    }
    return {root, turned};
  }
  void join(int i, int j, bool opposed) {
    const Membership a = find(i), b = find(j);
    if (a.root == b.root) {
      if ((a.turned ^ b.turned) != opposed) mixed_[a.root] = 1;
      return;
    }
    const int low = std::min(a.root, b.root), high = std::max(a.root, b.root);
    parent_[high] = low;
    turned_[high] = a.turned ^ b.turned ^ opposed ? 1 : 0;
    mixed_[low] |= mixed_[high];
  }
  bool is_mixed(int root) const { return mixed_[root] != 0; }

 private:
  std::vector<int> parent_;
  std::vector<char> turned_;  // 1: faces against its parent
  std::vector<char> mixed_;   // of a root, 1: a ring of its facets comes back turned over
};

}  // namespace

void FacetLoops::turn_over(int facet) {
  for (int l = facet_begin[facet]; l < facet_begin[facet + 1]; ++l) {
    std::reverse(corner.begin() + loop_begin[l] + 1, corner.begin() + loop_begin[l + 1]);
  }
}

Vector3d area_vector(const FacetLoops& facets, int facet, const std::vector<Vector3d>& points) {
  const Vector3d& origin = points[facets.loop(facets.facet_begin[facet])[0]];
  Vector3d sum = Vector3d::Zero();
  facets.for_each_edge(
      facet, [&](int a, int b) { sum += (points[a] - origin).cross(points[b] - origin); });
  return 0.5 * sum;
}

std::vector<EdgeUse> edge_uses(const FacetLoops& facets) {
  std::vector<EdgeUse> uses;
  uses.reserve(facets.corner.size());
  for (int f = 0; f < facets.count(); ++f) {
    facets.for_each_edge(f, [&](int a, int b) {
      uses.push_back({.low = std::min(a, b), .high = std::max(a, b), .facet = f, .forward = a < b});
    });
  }
  std::sort(uses.begin(), uses.end(), [](const EdgeUse& a, const EdgeUse& b) {
    return std::tie(a.low, a.high, a.facet, a.forward) <
           std::tie(b.low, b.high, b.facet, b.forward);
  });
  return uses;
}

std::vector<char> find_duplicates(const FacetLoops& facets, const std::vector<Vector3d>& points,
                                  bool either_facing) {
  std::vector<std::pair<std::uint64_t, int>> by_key;
  for (int f = 0; f < facets.count(); ++f) by_key.emplace_back(key_of(sorted_edges(facets, f)), f);
  std::sort(by_key.begin(), by_key.end());
  std::vector<char> is_duplicate(by_key.size(), 0);
  for (std::size_t begin = 0, end = 0; begin < by_key.size(); begin = end) {
    while (end < by_key.size() && by_key[end].first == by_key[begin].first) ++end;
    std::vector<int> kept;  // at most one of each facing, except for keys that agree by chance
    for (std::size_t i = begin; i < end && end - begin > 1; ++i) {
      const int f = by_key[i].second;
      is_duplicate[f] = std::any_of(kept.begin(), kept.end(), [&](int other) {
        return sorted_edges(facets, f) == sorted_edges(facets, other) &&
               (either_facing ||
                area_vector(facets, f, points).dot(area_vector(facets, other, points)) > 0.0);
      });
      if (!is_duplicate[f]) kept.push_back(f);
    }
  }
  return is_duplicate;
}

std::vector<char> find_reversed(const FacetLoops& facets, const std::vector<Vector3d>& points) {
  const int count = facets.count();
  std::vector<char> reversed(static_cast<std::size_t>(count), 0);
  const std::vector<EdgeUse> uses = edge_uses(facets);
  FacingGroups groups(count);
  bool any = false;
  for_each_edge_group(uses, [&](std::span<const EdgeUse> edge) {
    if (edge.size() != 2 || edge[0].facet == edge[1].facet) return;
    const bool opposed = edge[0].forward == edge[1].forward;
    any = any || opposed;
    groups.join(edge[0].facet, edge[1].facet, opposed);
  });
  if (!any) return reversed;
  std::vector<double> straight(reversed.size(), 0.0), turned(reversed.size(), 0.0);
  for (int f = 0; f < count; ++f) {
    const auto place = groups.find(f);
    (place.turned ? turned : straight)[place.root] += area_vector(facets, f, points).norm();
  }
  constexpr double clearly = 1.0 + 1e-6;  // a tie decides nothing
  for (int f = 0; f < count; ++f) {
    const auto [root, is_turned] = groups.find(f);
    if (groups.is_mixed(root)) continue;
    const double mine = (is_turned ? turned : straight)[root];
    const double others = (is_turned ? straight : turned)[root];
    reversed[f] = others > clearly * mine ? 1 : 0;
  }
  return reversed;
}

}  // namespace lightwell
