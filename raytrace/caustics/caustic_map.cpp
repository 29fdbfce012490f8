#include "raytrace/caustics/caustic_map.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <span>
#include <utility>

#include "raytrace/caustics/disc_kernel.h"
#include "scene/parallel.h"

namespace lightwell {
namespace {

constexpr int subtree_size = 4096;  // most discs of a thread's unit of work

}  // namespace

int CausticMap::neighbours(std::size_t count) {
  // The scale is measured on the focus of the glass sphere in the Cornell box.
  constexpr double scale = 0.04;
  constexpr int least = 16;
  return std::max(least, static_cast<int>(scale * std::pow(static_cast<double>(count), 2.0 / 3.0)));
}

CausticMap::CausticMap(const PatchMesh& mesh, const CausticPhotons& photons)
    : regions_(light_regions(mesh)), root_(static_cast<std::size_t>(regions_.count()), -1) {
  const int count = static_cast<int>(photons.count());
  power_.resize(0, mesh.emission.cols());
  if (count == 0) return;
  for (const Eigen::Vector3d& p : photons.position) origin_ += p / count;
  const auto region_of = [&](int photon) {
    return regions_.of_element[static_cast<std::size_t>(photons.element[photon])];
  };
  std::vector<int> order(static_cast<std::size_t>(count));
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(),
                   [&](int a, int b) { return region_of(a) < region_of(b); });
  for (const int i : order) {
    const auto p = static_cast<std::size_t>(i);
    tree_.discs.push_back({.center = (photons.position[p] - origin_).cast<float>(),
                           .normal = element_center(mesh, photons.element[p]).normal.cast<float>(),
                           .photon = i});
  }
  const int k = neighbours(photons.count());
  for (int begin = 0; begin < count;) {
    const int region = region_of(order[static_cast<std::size_t>(begin)]);
    int end = begin;
    while (end < count && region_of(order[static_cast<std::size_t>(end)]) == region) ++end;
    root_[static_cast<std::size_t>(region)] = tree_.build(begin, end);
    begin = end;
  }
  std::vector<Folded> folded(tree_.discs.size());
  for (int region = 0; region < regions_.count(); ++region) {
    if (root_[static_cast<std::size_t>(region)] < 0) continue;
    set_radii(region, k);
    fold_discs(region, folded);
  }
  insert(folded, photons.power);
}

void CausticMap::set_radii(int region, int k) {
  const int root = root_[static_cast<std::size_t>(region)];
  const DiscTree::Node& all = tree_.nodes[static_cast<std::size_t>(root)];
  const auto& bounds = regions_.bounds[static_cast<std::size_t>(region)];
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
std::vector<LightRegions::Edge> CausticMap::edges_about(
    const DiscTree::Node& node, std::span<const LightRegions::Edge> edges) const {
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

void CausticMap::fold_discs(int region, std::vector<Folded>& folded) const {
  std::vector<int> subtrees;
  tree_.collect(root_[static_cast<std::size_t>(region)], subtree_size, subtrees);
  const auto fold_leaf = [&](const DiscTree::Node& leaf,
                             std::span<const LightRegions::Edge> edges) {
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
      const auto near = edges_about(tree_.nodes[static_cast<std::size_t>(subtree)],
                                    regions_.bounds[static_cast<std::size_t>(region)]);
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
void CausticMap::insert(const std::vector<Folded>& folded, const BandArray& power) {
  std::size_t count = tree_.discs.size();
  for (const Folded& disc : folded) count += disc.mirrored.size();
  std::vector<DiscTree::Disc> all;
  all.reserve(count);
  power_.resize(static_cast<Eigen::Index>(count), power.cols());
  const auto add = [&](const DiscTree::Disc& disc, float weight) {
    // Rows of power_ follow the order of the discs, so that discs close in space are close in
    // memory.
    power_.row(static_cast<Eigen::Index>(all.size())) = weight * power.row(disc.photon);
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

Spectrum CausticMap::irradiance(const Eigen::Vector3d& point, const Eigen::Vector3d& normal,
                                int element) const {
  Spectrum E = Spectrum::Zero(power_.cols());
  const int root =
      root_[static_cast<std::size_t>(regions_.of_element[static_cast<std::size_t>(element)])];
  if (root < 0) return E;
  const Eigen::Vector3f p = (point - origin_).cast<float>(), n = normal.cast<float>();
  // The cosine of 60 degrees: between surfaces at larger angles light is not shared.
  constexpr float most_bend = 0.5f;
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
      continue;
    }
    for (int i = node.begin; i < node.end; ++i) {
      const DiscTree::Disc& disc = tree_.discs[static_cast<std::size_t>(i)];
      const float d2 = (disc.center - p).squaredNorm();
      if (!(d2 < disc.radius2) || !(n.dot(disc.normal) > most_bend)) continue;
      const float K = 1.0f - d2 / disc.radius2;
      const float* power = power_.data() + i * power_.cols();
      for (Eigen::Index k = 0; k < E.size(); ++k) E[k] += K * power[k];
    }
  }
  return E;
}

std::shared_ptr<const CausticMap> trace_caustics(const Scene& scene, const ElementCaster& caster,
                                                 const DirectLight& direct_light, int photons,
                                                 int max_specular_depth, const Progress& progress) {
  return std::make_shared<const CausticMap>(
      caster.mesh(),
      shoot_photons({scene, caster, direct_light}, photons, max_specular_depth, progress));
}

}  // namespace lightwell
