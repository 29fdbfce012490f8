#include "mesh/facets/group_facets.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <queue>
#include <vector>

#include "mesh/facets/merge_small_groups.h"

namespace lightwell {
namespace {

using Eigen::Vector3d;

constexpr double most_facet = 0.5;  // of a patch's area: a larger facet is a patch of its own
// A share of the patch size: a disc of this radius has the area of 1.5 patches.
constexpr double reach = 0.7;
constexpr double join_share = 0.5;   // of a patch's area: a smaller group joins a neighbour
constexpr double most_extent = 2.5;  // of the reach: largest diagonal of two joined groups
constexpr double most_area = most_group_area;

class Grower {
 public:
  Grower(const std::vector<FacetPatch>& patches, const std::vector<FacetPatchContact>& contacts,
         const FacetGroupOptions& options)
      : patches_(patches),
        cell_area_(options.patch_size * options.patch_size),
        reach_(reach * options.patch_size),
        least_to_mean_(std::cos(options.radians())),
        least_to_seed_(std::cos(seed_angle * options.radians())),
        group_(patches.size(), -1) {
    first_.assign(patches.size() + 1, 0);
    for (const FacetPatchContact& c : contacts) ++first_[c.one + 1], ++first_[c.other + 1];
    std::partial_sum(first_.begin(), first_.end(), first_.begin());
    neighbour_.resize(2 * contacts.size());
    std::vector<int> next(first_.begin(), first_.end() - 1);
    for (const FacetPatchContact& c : contacts) {
      neighbour_[next[c.one]++] = c.other;
      neighbour_[next[c.other]++] = c.one;
    }
  }

  /// Returns for each patch a member of its group, equal for all members.
  std::vector<int> grow_all() {
    std::vector<int> order(patches_.size());
    std::iota(order.begin(), order.end(), 0);
    // Rounded, so that equal facets keep their order in every unit and at every place.
    const auto share = [&](int i) { return std::round(1e6 * patches_[i].area / cell_area_); };
    std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return share(a) > share(b); });
    members_.resize(patches_.size());
    area_.resize(patches_.size(), 0.0);
    // A released patch is appended to `order` and later begins a group of its own.
    for (std::size_t k = 0; k < order.size(); ++k) {
      if (group_[order[k]] < 0) grow(order[k], order);
    }
    std::vector<int> small;
    for (const int g : order) {
      if (group_[g] == g && area_[g] < join_share * cell_area_) small.push_back(g);
    }
    std::reverse(small.begin(), small.end());
    for (const int g : small) join_neighbour(g);
    return group_;
  }

 private:
  bool is_small(const FacetPatch& p) const {
    return p.may_join && p.area <= most_facet * cell_area_;
  }
  double area_of(const std::vector<int>& members) const {
    double area = 0.0;
    for (const int i : members) area += patches_[i].area;
    return area;
  }
  Vector3d mean_of(const std::vector<int>& members) const {
    Vector3d sum = Vector3d::Zero();
    for (const int i : members) sum += patches_[i].area * patches_[i].normal;
    return sum.normalized();
  }

  void grow(int seed, std::vector<int>& order) {
    std::vector<int>& members = members_[seed];
    group_[seed] = seed;
    members = {seed};
    area_[seed] = patches_[seed].area;
    const FacetPatch& first = patches_[seed];
    if (!is_small(first)) return;
    const Vector3d center = first.box.center();
    // The distance in whole millionths of the reach, so that rounding decides no ties.
    const auto distance = [&](int i) {
      return std::round(1e6 * (patches_[i].box.center() - center).norm() / reach_);
    };
    using Entry = std::pair<double, int>;
    std::priority_queue<Entry, std::vector<Entry>, std::greater<>> open;
    const auto add_neighbours = [&](int of) {
      for (int k = first_[of]; k < first_[of + 1]; ++k) {
        const int i = neighbour_[k];
        const FacetPatch& next = patches_[i];
        if (group_[i] >= 0 || !is_small(next) || next.surface != first.surface) continue;
        if (!(next.normal.dot(first.normal) >= least_to_seed_)) continue;
        const double d = distance(i);
        if (d <= 1e6) open.emplace(d, i);
      }
    };
    double area = first.area;
    add_neighbours(seed);
    while (!open.empty()) {
      const int i = open.top().second;
      open.pop();
      if (group_[i] >= 0 || area + patches_[i].area > most_area * cell_area_) continue;
      group_[i] = seed;
      members.push_back(i);
      area += patches_[i].area;
      add_neighbours(i);
    }
    // The seed is never released: the mean is no farther from the seed than the members are.
    for (bool is_settled = false; !is_settled;) {
      const Vector3d mean = mean_of(members);
      is_settled = std::erase_if(members, [&](int i) {
                     if (i == seed || patches_[i].normal.dot(mean) >= least_to_mean_) return false;
                     group_[i] = -1;
                     order.push_back(i);
                     return true;
                   }) == 0;
    }
    area_[seed] = area_of(members);
  }

  // Joins a group that is left over with the smallest neighbour that has room.
  void join_neighbour(int g) {
    if (group_[g] != g || !is_small(patches_[g])) return;
    int best = -1;
    double least = most_area * cell_area_ - area_[g];
    std::vector<int> seen{g};
    for (const int i : members_[g]) {
      for (int k = first_[i]; k < first_[i + 1]; ++k) {
        const int other = group_[neighbour_[k]];
        if (std::count(seen.begin(), seen.end(), other) > 0) continue;
        seen.push_back(other);
        if (!is_small(patches_[other]) || patches_[other].surface != patches_[g].surface) continue;
        if (!(area_[other] < least) || !fit_together(g, other)) continue;
        least = area_[other];
        best = other;
      }
    }
    if (best < 0) return;
    for (const int i : members_[g]) group_[i] = best;
    members_[best].insert(members_[best].end(), members_[g].begin(), members_[g].end());
    members_[g].clear();
    area_[best] += area_[g];
  }

  bool fit_together(int g, int other) const {
    std::vector<int> all = members_[g];
    all.insert(all.end(), members_[other].begin(), members_[other].end());
    const Vector3d mean = mean_of(all);
    Eigen::AlignedBox3d box;
    for (const int i : all) {
      if (!(patches_[i].normal.dot(mean) >= least_to_mean_)) return false;
      box.extend(patches_[i].box.center());
    }
    return box.diagonal().norm() <= most_extent * reach_;
  }

  const std::vector<FacetPatch>& patches_;
  double cell_area_, reach_;
  double least_to_mean_, least_to_seed_;  // cosines
  std::vector<int> first_, neighbour_;
  std::vector<int> group_;
  std::vector<std::vector<int>> members_;  // by seed
  std::vector<double> area_;               // by seed
};

}  // namespace

std::vector<int> group_facets(const std::vector<FacetPatch>& patches,
                              const std::vector<FacetPatchContact>& contacts,
                              const FacetGroupOptions& options) {
  std::vector<int> group = Grower(patches, contacts, options).grow_all();
  merge_small_groups(patches, options, group);
  // Groups are named by their lowest member.
  std::vector<int> lowest(patches.size(), -1);
  for (std::size_t i = 0; i < group.size(); ++i) {
    int& low = lowest[group[i]];
    if (low < 0) low = static_cast<int>(i);
    group[i] = low;
  }
  return group;
}

}  // namespace lightwell
