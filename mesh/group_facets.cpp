#include "mesh/group_facets.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <numbers>
#include <numeric>
#include <queue>
#include <set>
#include <tuple>

namespace lightwell {
namespace {

using Eigen::Vector3d;

constexpr double most_facet = 0.5;    // of a patch's area: a larger facet is a patch of its own
constexpr double most_area = 1.2;     // of a patch's area
constexpr double reach = 0.7;         // of the patch size: a disc of 1.5 patches, cut by others
constexpr double join_share = 0.5;    // of a patch's area: less is left over
constexpr double most_extent = 2.5;   // of the reach
constexpr double least_share = 0.15;  // of a patch's area, as inside a facet
constexpr double seed_angle = 0.75;   // of the angle: the mean may move away from the seed

class Grower {
 public:
  Grower(const std::vector<FacetPatch>& patches, const std::vector<FacetPatchContact>& contacts,
         const FacetGroupOptions& options)
      : patches_(patches),
        cell_area_(options.patch_size * options.patch_size),
        reach_(reach * options.patch_size),
        least_to_mean_(std::cos(radians(options.angle_degrees))),
        least_to_seed_(std::cos(radians(seed_angle * options.angle_degrees))),
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

  /// A member of each patch's group, the same for all of them.
  std::vector<int> grow_all() {
    std::vector<int> order(patches_.size());
    std::iota(order.begin(), order.end(), 0);
    // Rounded, so that equal facets fall alike in every unit and place.
    const auto share = [&](int i) { return std::round(1e6 * patches_[i].area / cell_area_); };
    std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return share(a) > share(b); });
    members_.resize(patches_.size());
    area_.resize(patches_.size(), 0.0);
    // What a group lets go of again begins one of its own later.
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
  static double radians(double degrees) { return degrees * std::numbers::pi / 180.0; }

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
    // In millionths of the reach, so that ties fall alike.
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
    // The seed stays: the mean is no farther from it than the members are.
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

  // What the groups around have left over joins the smallest of them that it fits.
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

// One of 54 directions: 3 x 3 on each face of a cube, even in angle.
int direction_of(const Vector3d& normal) {
  int axis = 0;
  normal.cwiseAbs().maxCoeff(&axis);
  const auto third = [&](int k) {
    const double angle = std::atan(normal[(axis + k) % 3] / std::abs(normal[axis]));
    constexpr double sixth_turn_of_face = std::numbers::pi / 12.0;
    return angle < -sixth_turn_of_face ? 0 : angle > sixth_turn_of_face ? 2 : 1;
  };
  return ((2 * axis + (normal[axis] < 0.0 ? 1 : 0)) * 3 + third(1)) * 3 + third(2);
}

struct GroupSum {
  int members = 0;
  double area = 0.0;
  Vector3d normal = Vector3d::Zero(), center = Vector3d::Zero();  // times area
  bool may_join = true;
  std::vector<int> facets{};
};

// Small groups of one surface, place and direction become one.
void join_small(const std::vector<FacetPatch>& patches, double patch_size,
                std::vector<int>& group) {
  std::vector<GroupSum> sums(patches.size());
  Eigen::AlignedBox3d bounds;
  for (std::size_t i = 0; i < patches.size(); ++i) {
    GroupSum& sum = sums[group[i]];
    const FacetPatch& p = patches[i];
    ++sum.members;
    sum.area += p.area;
    sum.normal += p.area * p.normal;
    sum.center += p.area * p.box.center();
    sum.may_join = sum.may_join && p.may_join;
    sum.facets.push_back(p.facet);
    bounds.extend(p.box);
  }
  using Place = std::tuple<int, int, std::int64_t, std::int64_t, std::int64_t>;
  struct Cluster {
    int group = -1;
    double area = 0.0;
    std::set<int> facets{};
  };
  std::map<Place, Cluster> clusters;
  std::vector<int> joined(patches.size());
  std::iota(joined.begin(), joined.end(), 0);
  for (std::size_t g = 0; g < sums.size(); ++g) {
    const GroupSum& sum = sums[g];
    if (sum.members == 0 || !sum.may_join || !(sum.area > 0.0)) continue;
    if (!(sum.area < least_share * patch_size * patch_size)) continue;
    const Vector3d at = (sum.center / sum.area - bounds.min()) / patch_size;
    const auto cell = [&](int c) { return static_cast<std::int64_t>(std::floor(at[c])); };
    Cluster& cluster =
        clusters[{patches[g].surface, direction_of(sum.normal), cell(0), cell(1), cell(2)}];
    // A full one is closed: the next begins.
    if (cluster.group < 0 || cluster.area + sum.area > most_area * patch_size * patch_size) {
      cluster = {.group = static_cast<int>(g)};
    }
    if (std::any_of(sum.facets.begin(), sum.facets.end(),
                    [&](int f) { return cluster.facets.contains(f); })) {
      continue;
    }
    cluster.facets.insert(sum.facets.begin(), sum.facets.end());
    joined[g] = cluster.group;
    cluster.area += sum.area;
  }
  for (int& g : group) g = joined[g];
}

}  // namespace

std::vector<int> group_facets(const std::vector<FacetPatch>& patches,
                              const std::vector<FacetPatchContact>& contacts,
                              const FacetGroupOptions& options) {
  std::vector<int> group = Grower(patches, contacts, options).grow_all();
  join_small(patches, options.patch_size, group);
  // Named by their lowest member.
  std::vector<int> lowest(patches.size(), -1);
  for (std::size_t i = 0; i < group.size(); ++i) {
    int& low = lowest[group[i]];
    if (low < 0) low = static_cast<int>(i);
    group[i] = low;
  }
  return group;
}

}  // namespace lightwell
