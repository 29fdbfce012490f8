#include "mesh/facets/merge_small_groups.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <set>
#include <tuple>

namespace lightwell {
namespace {

using Eigen::Vector3d;

// Share of a patch's area below which a group is a crumb, as in group_patches.cpp. Shares of 0,
// 0.05, 0.15 and 0.3 give 12 061, 8610, 8219 and 8083 front patches of a furnished room.
constexpr double least_share = 0.15;

class Joiner {
 public:
  Joiner(const std::vector<FacetPatch>& patches, const FacetGroupOptions& options,
         std::vector<int>& group)
      : patches_(patches),
        group_(group),
        cell_area_(options.patch_size * options.patch_size),
        patch_size_(options.patch_size),
        least_to_mean_(std::cos(options.radians())),
        least_to_seed_(std::cos(options.radians())),
        groups_(patches.size()) {
    for (std::size_t i = 0; i < patches.size(); ++i) {
      Group& g = groups_[group[i]];
      const FacetPatch& p = patches[i];
      g.members.push_back(static_cast<int>(i));
      g.area += p.area;
      g.normal += p.area * p.normal;
      g.center += p.area * p.box.center();
      g.may_join = g.may_join && p.may_join;
      bounds_.extend(p.box);
    }
  }

  void join_all() {
    std::vector<int> open;
    for (int g = 0; g < static_cast<int>(groups_.size()); ++g) {
      const Group& group = groups_[g];
      if (!group.members.empty() && group.may_join && group.area > 0.0 &&
          group.area < least_share * cell_area_) {
        open.push_back(g);
      }
    }
    // Groups that clusters release, each time fewer, begin other clusters.
    while (!open.empty()) open = join(open);
  }

 private:
  struct Group {
    std::vector<int> members{};  // numbers of patches
    double area = 0.0;
    Vector3d normal = Vector3d::Zero(), center = Vector3d::Zero();  // times area
    bool may_join = true;
  };
  struct Cluster {
    std::vector<int> groups{};  // the first is the seed
    double area = 0.0;
    Vector3d axis = Vector3d::Zero();
    std::set<int> facets{};
  };
  using CellKey = std::tuple<int, std::int64_t, std::int64_t, std::int64_t>;

  CellKey cell_of(const Group& group) const {
    const Vector3d at = (group.center / group.area - bounds_.min()) / patch_size_;
    const auto cell = [&](int c) { return static_cast<std::int64_t>(std::floor(at[c])); };
    return {patches_[group.members.front()].surface, cell(0), cell(1), cell(2)};
  }

  bool lies_within(const Group& group, const Vector3d& axis, double least_cosine) const {
    return std::all_of(group.members.begin(), group.members.end(),
                       [&](int i) { return patches_[i].normal.dot(axis) >= least_cosine; });
  }

  bool shares_facet(const Group& group, const Cluster& cluster) const {
    return std::any_of(group.members.begin(), group.members.end(),
                       [&](int i) { return cluster.facets.contains(patches_[i].facet); });
  }

  void add(int g, Cluster& cluster) const {
    cluster.groups.push_back(g);
    cluster.area += groups_[g].area;
    for (const int i : groups_[g].members) cluster.facets.insert(patches_[i].facet);
  }

  // Fills clusters with the groups in order; returns the groups that were released.
  std::vector<int> join(const std::vector<int>& open) {
    std::map<CellKey, std::vector<Cluster>> filling;
    std::vector<int> let_go;
    for (const int g : open) {
      const Group& group = groups_[g];
      std::vector<Cluster>& here = filling[cell_of(group)];
      const auto fitting = std::find_if(here.begin(), here.end(), [&](const Cluster& c) {
        return lies_within(group, c.axis, least_to_seed_) && !shares_facet(group, c);
      });
      if (fitting != here.end()) {
        if (fitting->area + group.area <= most_group_area * cell_area_) {
          add(g, *fitting);
          continue;
        }
        close(*fitting, let_go);
        here.erase(fitting);
      }
      Cluster& next = here.emplace_back();
      next.axis = group.normal.normalized();
      add(g, next);
    }
    for (auto& [place, clusters] : filling) {
      for (Cluster& cluster : clusters) close(cluster, let_go);
    }
    std::sort(let_go.begin(), let_go.end());
    return let_go;
  }

  // Releases groups until all normals are within the angle of the mean, and names the rest by the
  // seed, which always stays.
  void close(Cluster& cluster, std::vector<int>& let_go) {
    std::vector<int>& kept = cluster.groups;
    for (bool is_settled = false; !is_settled;) {
      Vector3d mean = Vector3d::Zero();
      for (const int g : kept) mean += groups_[g].normal;
      mean.normalize();
      const auto suits = [&](int g) { return lies_within(groups_[g], mean, least_to_mean_); };
      const std::size_t before = kept.size();
      for (std::size_t k = 1; k < kept.size(); ++k) {
        if (!suits(kept[k])) let_go.push_back(kept[k]);
      }
      kept.erase(std::remove_if(kept.begin() + 1, kept.end(), [&](int g) { return !suits(g); }),
                 kept.end());
      is_settled = kept.size() == before;
      if (is_settled && kept.size() > 1 && !suits(kept.front())) {
        let_go.insert(let_go.end(), kept.begin() + 1, kept.end());
        kept.resize(1);
      }
    }
    for (const int g : kept) {
      for (const int i : groups_[g].members) group_[i] = kept.front();
    }
  }

  const std::vector<FacetPatch>& patches_;
  std::vector<int>& group_;
  double cell_area_, patch_size_;
  double least_to_mean_, least_to_seed_;  // cosines
  std::vector<Group> groups_;
  Eigen::AlignedBox3d bounds_;
};

}  // namespace

void merge_small_groups(const std::vector<FacetPatch>& patches, const FacetGroupOptions& options,
                        std::vector<int>& group) {
  Joiner(patches, options, group).join_all();
}

}  // namespace lightwell
