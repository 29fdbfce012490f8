#include "raytrace/caustics/photon_discs.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <span>
#include <utility>

#include "raytrace/caustics/disc_kernel.h"
#include "scene/parallel.h"

namespace lightwell {
namespace {

constexpr int subtree_size = 4096;  // most discs of a thread's unit of work

}  // namespace

PhotonDiscs::PhotonDiscs(const LightRegions& regions, PhotonTree tree, const PhotonSums& photons,
                         int k, int fewest)
    : origin_(tree.origin), tree_(std::move(tree.tree)), root_(std::move(tree.root)) {
  std::vector<Folded> folded(tree_.discs.size());
  for (std::size_t r = 0; r < root_.size(); ++r) {
    if (root_[r] < 0) continue;
    const DiscTree::Node& all = tree_.nodes[static_cast<std::size_t>(root_[r])];
    if (all.end - all.begin < fewest) {
      root_[r] = -1;
      continue;
    }
    set_radii(root_[r], regions.bounds[r], k);
    fold_discs(root_[r], regions.bounds[r], folded);
  }
  insert(folded, photons);
}

void PhotonDiscs::set_radii(int root, Edges bounds, int k) {
  const DiscTree::Node& all = tree_.nodes[static_cast<std::size_t>(root)];
  // With at most k photons, each is spread over the whole region.
  const bool are_few = all.end - all.begin <= k;
  float size2 = (all.high - all.low).square().sum();
  for (const LightRegions::Edge& edge : bounds) {
    const Eigen::Array3f from = (edge.from - origin_).cast<float>().array();
    size2 = std::max(size2, 4.0f * (from - 0.5f * (all.low + all.high)).square().sum());
  }
  const auto set = [&](const DiscTree::Node& group, float radius2) {
    for (int i = group.begin; i < group.end; ++i) {
      tree_.discs[static_cast<std::size_t>(i)].radius2 = std::max(radius2, 1e-12f * size2);
    }
  };
  if (are_few) return set(all, size2);
  std::vector<int> subtrees;
  tree_.collect(root, subtree_size, subtrees);
  parallel_for(static_cast<int>(subtrees.size()), 1, [&](int begin, int end) {
    NearestDiscs nearest(tree_, k);
    for (int s = begin; s < end; ++s) {
      const int subtree = subtrees[static_cast<std::size_t>(s)];
      // About k / 10 neighbouring discs share a radius, which varies little over a small part of a
      // disc.
      constexpr int part = 10;
      std::vector<int> groups;
      tree_.collect(subtree, k / part, groups);
      for (const int g : groups) {
        const DiscTree::Node& group = tree_.nodes[static_cast<std::size_t>(g)];
        set(group, nearest.distance2_to_last(root, 0.5f * (group.low + group.high)));
      }
      // The radius of a disc that reaches over the boundary was too large, since only its area
      // within has neighbours.
      const auto near = edges_about(tree_.nodes[static_cast<std::size_t>(subtree)], bounds);
      for (const int g : groups) {
        const DiscTree::Node& group = tree_.nodes[static_cast<std::size_t>(g)];
        const DiscTree::Disc& disc = tree_.discs[static_cast<std::size_t>(group.begin)];
        const Eigen::Vector3f middle = 0.5f * (group.low + group.high);
        set(group, disc.radius2 * static_cast<float>(disc_within(
                                      middle.cast<double>() + origin_, disc.normal.cast<double>(),
                                      std::sqrt(double{disc.radius2}), edges_about(group, near))));
      }
    }
  });
}

// Returns the edges whose boxes the discs of a node may reach.
std::vector<LightRegions::Edge> PhotonDiscs::edges_about(const DiscTree::Node& node,
                                                         Edges edges) const {
  float radius2 = 0.0f;
  for (int i = node.begin; i < node.end; ++i) {
    radius2 = std::max(radius2, tree_.discs[static_cast<std::size_t>(i)].radius2);
  }
  const double r = std::sqrt(double{radius2});
  const Eigen::Array3d low = node.low.cast<double>() - r, high = node.high.cast<double>() + r;
  std::vector<LightRegions::Edge> found;
  for (const LightRegions::Edge& edge : edges) {
    const Eigen::Array3d from = (edge.from - origin_).array(), to = (edge.to - origin_).array();
    if ((from.min(to) <= high).all() && (from.max(to) >= low).all()) found.push_back(edge);
  }
  return found;
}

void PhotonDiscs::fold_discs(int root, Edges bounds, std::vector<Folded>& folded) const {
  std::vector<int> subtrees;
  tree_.collect(root, subtree_size, subtrees);
  const auto fold_leaf = [&](const DiscTree::Node& leaf, Edges edges) {
    for (int i = leaf.begin; i < leaf.end; ++i) {
      const DiscTree::Disc& disc = tree_.discs[static_cast<std::size_t>(i)];
      const Eigen::Vector3d center = disc.center.cast<double>() + origin_,
                            normal = disc.normal.cast<double>();
      const FoldedDisc found = fold(center, normal, std::sqrt(double{disc.radius2}), edges);
      Folded& result = folded[static_cast<std::size_t>(i)];
      result.weight =
          2.0f / (std::numbers::pi_v<float> * disc.radius2 * static_cast<float>(found.within));
      for (const Eigen::Vector3d& mirrored : found.mirrored) {
        result.mirrored.emplace_back((mirrored - origin_).cast<float>());
      }
    }
  };
  parallel_for(static_cast<int>(subtrees.size()), 1, [&](int begin, int end) {
    for (int s = begin; s < end; ++s) {
      const int subtree = subtrees[static_cast<std::size_t>(s)];
      const auto near = edges_about(tree_.nodes[static_cast<std::size_t>(subtree)], bounds);
      std::vector<int> leaves;
      tree_.collect(subtree, DiscTree::leaf_size, leaves);
      for (const int l : leaves) {
        const DiscTree::Node& leaf = tree_.nodes[static_cast<std::size_t>(l)];
        fold_leaf(leaf, edges_about(leaf, near));
      }
    }
  });
}

// Inserts mirror images after their own discs, and fits the boxes of all nodes to the discs'
// extents.
void PhotonDiscs::insert(const std::vector<Folded>& folded, const PhotonSums& photons) {
  std::size_t count = tree_.discs.size();
  for (const Folded& disc : folded) count += disc.mirrored.size();
  std::vector<DiscTree::Disc> all;
  all.reserve(count);
  const Eigen::Index bands = photons.power.cols();
  power_.resize(static_cast<Eigen::Index>(count), bands + 1);
  const auto add = [&](const DiscTree::Disc& disc, float weight) {
    // Rows of power_ follow the order of the discs, so that discs close in space are close in
    // memory.
    auto row = power_.row(static_cast<Eigen::Index>(all.size()));
    row.head(bands) = weight * photons.power.row(disc.photon);
    row[bands] = weight * weight * photons.square[disc.photon];
    all.push_back(disc);
  };
  for (DiscTree::Node& leaf : tree_.nodes) {
    if (leaf.second >= 0) continue;
    const auto begin = static_cast<int>(all.size());
    for (int i = leaf.begin; i < leaf.end; ++i) {
      DiscTree::Disc disc = tree_.discs[static_cast<std::size_t>(i)];
      const Folded& more = folded[static_cast<std::size_t>(i)];
      add(disc, more.weight);
      for (const Eigen::Vector3f& center : more.mirrored) {
        disc.center = center;
        add(disc, more.weight);
      }
    }
    leaf.begin = begin;
    leaf.end = static_cast<int>(all.size());
  }
  tree_.discs = std::move(all);
  for (auto n = static_cast<int>(tree_.nodes.size()) - 1; n >= 0; --n) {
    DiscTree::Node& node = tree_.nodes[static_cast<std::size_t>(n)];
    if (node.second >= 0) {
      const DiscTree::Node& first = tree_.nodes[static_cast<std::size_t>(n) + 1];
      const DiscTree::Node& second = tree_.nodes[static_cast<std::size_t>(node.second)];
      node = {first.low.min(second.low), first.high.max(second.high), first.begin, second.end,
              node.second};
      continue;
    }
    for (int i = node.begin; i < node.end; ++i) {
      const DiscTree::Disc& disc = tree_.discs[static_cast<std::size_t>(i)];
      const float r = std::sqrt(disc.radius2);
      node.low = node.low.min(disc.center.array() - r);
      node.high = node.high.max(disc.center.array() + r);
    }
  }
}

// Adds the discs of a leaf to the sums at a point, of the columns of power_. With three bands, as
// most scenes have, the sums stay in registers.
template <int Columns>
void PhotonDiscs::add_leaf(const DiscTree::Node& leaf, const Eigen::Vector3f& point,
                           const Eigen::Vector3f& normal, float* sums) const {
  // The cosine of 60 degrees: between surfaces at larger angles light is not shared.
  constexpr float most_bend = 0.5f;
  const auto columns = Columns > 0 ? Columns : static_cast<int>(power_.cols());
  for (int i = leaf.begin; i < leaf.end; ++i) {
    const DiscTree::Disc& disc = tree_.discs[static_cast<std::size_t>(i)];
    const float d2 = (disc.center - point).squaredNorm();
    if (!(d2 < disc.radius2) || !(normal.dot(disc.normal) > most_bend)) continue;
    const float K = 1.0f - d2 / disc.radius2;
    const float* power = power_.data() + Eigen::Index{i} * columns;
    for (int k = 0; k + 1 < columns; ++k) sums[k] += K * power[k];
    sums[columns - 1] += K * K * power[columns - 1];
  }
}

PhotonDensity PhotonDiscs::at(const Eigen::Vector3d& point, const Eigen::Vector3d& normal,
                              int region) const {
  const Eigen::Index bands = power_.cols() - 1;
  PhotonDensity found{.irradiance = Spectrum::Zero(bands)};
  const int root = root_[static_cast<std::size_t>(region)];
  if (root < 0) return found;
  const Eigen::Vector3f p = (point - origin_).cast<float>(), n = normal.cast<float>();
  std::array<float, max_bands + 1> sums{};
  std::array<int, 64> stack;
  int depth = 0;
  stack[depth++] = root;
  while (depth > 0) {
    const int number = stack[--depth];
    const DiscTree::Node& node = tree_.nodes[static_cast<std::size_t>(number)];
    if ((p.array() < node.low).any() || (p.array() > node.high).any()) continue;
    if (node.second >= 0) {
      stack[depth++] = node.second;
      stack[depth++] = number + 1;
    } else if (bands == 3) {
      add_leaf<4>(node, p, n, sums.data());
    } else {
      add_leaf<0>(node, p, n, sums.data());
    }
  }
  found.irradiance = Eigen::Map<const Eigen::ArrayXf>(sums.data(), bands);
  found.variance = double{sums[static_cast<std::size_t>(bands)]};
  return found;
}

}  // namespace lightwell
