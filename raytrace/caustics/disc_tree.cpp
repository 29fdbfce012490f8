#include "raytrace/caustics/disc_tree.h"

#include <algorithm>
#include <array>
#include <limits>
#include <utility>

namespace lightwell {
namespace {

// Squared distance of a point from a box.
float distance2(const Eigen::Array3f& p, const Eigen::Array3f& low, const Eigen::Array3f& high) {
  return (low - p).max(p - high).max(0.0f).square().sum();
}

}  // namespace

int DiscTree::build(int begin, int end) {
  const auto number = static_cast<int>(nodes.size());
  Node node{
      .low = discs[static_cast<std::size_t>(begin)].center.array(), .begin = begin, .end = end};
  node.high = node.low;
  for (int i = begin; i < end; ++i) {
    const Eigen::Array3f p = discs[static_cast<std::size_t>(i)].center.array();
    node.low = node.low.min(p);
    node.high = node.high.max(p);
  }
  nodes.push_back(node);
  if (end - begin <= leaf_size) return number;
  Eigen::Index axis = 0;
  (node.high - node.low).maxCoeff(&axis);
  const int middle = begin + (end - begin) / 2;
  std::nth_element(discs.begin() + begin, discs.begin() + middle, discs.begin() + end,
                   [axis](const Disc& a, const Disc& b) {
                     return std::pair(a.center[axis], a.photon) <
                            std::pair(b.center[axis], b.photon);
                   });
  build(begin, middle);
  const int second = build(middle, end);
  nodes[static_cast<std::size_t>(number)].second = second;
  return number;
}

void DiscTree::collect(int n, int most, std::vector<int>& found) const {
  const Node& node = nodes[static_cast<std::size_t>(n)];
  if (node.second < 0 || node.end - node.begin <= most) {
    found.push_back(n);
    return;
  }
  collect(n + 1, most, found);
  collect(node.second, most, found);
}

NearestDiscs::NearestDiscs(const DiscTree& tree, int k)
    : tree_(tree), k_(static_cast<std::size_t>(k)) {
  heap_.reserve(k_);
}

float NearestDiscs::distance2_to_last(int root, const Eigen::Vector3f& from) {
  heap_.clear();
  visit(root, from);
  return heap_.front();
}

float NearestDiscs::reach() const {
  return heap_.size() < k_ ? std::numeric_limits<float>::infinity() : heap_.front();
}

void NearestDiscs::visit(int n, const Eigen::Vector3f& from) {
  const DiscTree::Node& node = tree_.nodes[static_cast<std::size_t>(n)];
  if (node.second < 0) {
    for (int i = node.begin; i < node.end; ++i) {
      add((tree_.discs[static_cast<std::size_t>(i)].center - from).squaredNorm());
    }
    return;
  }
  std::array<int, 2> child = {n + 1, node.second};
  std::array<float, 2> away{};
  for (std::size_t c = 0; c < 2; ++c) {
    const DiscTree::Node& other = tree_.nodes[static_cast<std::size_t>(child[c])];
    away[c] = distance2(from.array(), other.low, other.high);
  }
  const std::size_t near = away[1] < away[0] ? 1 : 0;
  for (const std::size_t c : {near, 1 - near}) {
    if (away[c] < reach()) visit(child[c], from);
  }
}

void NearestDiscs::add(float distance2) {
  if (!(distance2 < reach())) return;
  if (heap_.size() == k_) {
    std::pop_heap(heap_.begin(), heap_.end());
    heap_.pop_back();
  }
  heap_.push_back(distance2);
  std::push_heap(heap_.begin(), heap_.end());
}

}  // namespace lightwell
