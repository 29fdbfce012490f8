#include "mesh/geometry/box_tree.h"

#include <algorithm>
#include <limits>
#include <numeric>

namespace lightwell {

BoxTree::BoxTree(std::vector<Box> boxes) : boxes_(std::move(boxes)), order_(boxes_.size()) {
  std::iota(order_.begin(), order_.end(), 0);
  nodes_.reserve(boxes_.size());
  std::vector<Key> keys(boxes_.size());
  if (!boxes_.empty()) build(0, static_cast<int>(boxes_.size()), keys);
}

int BoxTree::build(int begin, int end, std::vector<Key>& keys) {
  constexpr int leaf_size = 4;
  const int index = static_cast<int>(nodes_.size());
  nodes_.push_back({.begin = begin, .end = end});
  Box box, centers;
  int highest = 0;
  for (int i = begin; i < end; ++i) {
    box.extend(boxes_[order_[i]]);
    centers.extend(boxes_[order_[i]].center());
    highest = std::max(highest, order_[i]);
  }
  nodes_[index].box = box;
  nodes_[index].highest = highest;
  if (end - begin <= leaf_size) return index;

  int axis = 0;
  centers.sizes().maxCoeff(&axis);
  const int middle = begin + (end - begin) / 2;
  for (int i = begin; i < end; ++i) keys[i] = {boxes_[order_[i]].center()[axis], order_[i]};
  std::nth_element(keys.begin() + begin, keys.begin() + middle, keys.begin() + end);
  for (int i = begin; i < end; ++i) order_[i] = keys[i].second;
  build(begin, middle, keys);
  const int right = build(middle, end, keys);
  nodes_[index].right = right;
  return index;
}

template <class Meets>
bool BoxTree::collect(const Meets& meets, std::int64_t& visits, std::vector<int>& found) const {
  found.clear();
  if (nodes_.empty()) return true;
  std::array<int, deepest> stack;
  int depth = 0;
  stack[depth++] = 0;
  while (depth > 0) {
    const int index = stack[--depth];
    const Node& node = nodes_[index];
    if (visits-- <= 0) {
      found.clear();
      return false;
    }
    if (!meets(node.box)) continue;
    if (node.right != 0) {
      stack[depth++] = node.right;
      stack[depth++] = index + 1;
      continue;
    }
    for (int i = node.begin; i < node.end; ++i) {
      if (meets(boxes_[order_[i]])) found.push_back(order_[i]);
    }
  }
  return true;
}

void BoxTree::find_overlaps(const Box& query, std::vector<int>& found) const {
  find_overlaps_from(0, query, found);
}

void BoxTree::find_overlaps_from(int first, const Box& query, std::vector<int>& found) const {
  found.clear();
  if (nodes_.empty()) return;
  // Box::intersects() compares all axes before it answers, which takes most of the time here.
  const Eigen::Vector3d low = query.min(), high = query.max();
  const auto meets = [&](const Box& box) {
    for (int c = 0; c < 3; ++c) {
      if (!(box.min()[c] <= high[c] && low[c] <= box.max()[c])) return false;
    }
    return true;
  };
  std::array<int, deepest> stack;
  int depth = 0;
  const auto open = [&](int index) {
    if (nodes_[index].highest >= first && meets(nodes_[index].box)) stack[depth++] = index;
  };
  open(0);
  while (depth > 0) {
    const int index = stack[--depth];
    const Node& node = nodes_[index];
    if (node.right != 0) {
      open(node.right);
      open(index + 1);
      continue;
    }
    for (int i = node.begin; i < node.end; ++i) {
      if (order_[i] >= first && meets(boxes_[order_[i]])) found.push_back(order_[i]);
    }
  }
  std::sort(found.begin(), found.end());
}

void BoxTree::find_on_plane(const Box& query, const Eigen::Hyperplane<double, 3>& plane,
                            std::vector<int>& found) const {
  const auto meets = [&](const Box& box) {
    if (!box.intersects(query)) return false;
    const double reach = 0.5 * box.sizes().dot(plane.normal().cwiseAbs());
    return plane.absDistance(box.center()) <= reach;
  };
  std::int64_t visits = std::numeric_limits<std::int64_t>::max();
  collect(meets, visits, found);
  std::sort(found.begin(), found.end());
}

bool BoxTree::find_before(std::span<const Eigen::Hyperplane<double, 3>> planes, double least,
                          std::int64_t& visits, std::vector<int>& found) const {
  // A box is before a plane where its corner farthest along the normal is.
  const auto meets = [&](const Box& box) {
    return std::ranges::all_of(planes, [&](const Eigen::Hyperplane<double, 3>& plane) {
      const auto farthest = [&](int c) {
        const double n = plane.normal()[c];
        return std::max(n * box.min()[c], n * box.max()[c]);
      };
      return farthest(0) + farthest(1) + farthest(2) + plane.offset() > least;
    });
  };
  return collect(meets, visits, found);
}

bool BoxTree::find_along(const Eigen::Vector3d& a, const Eigen::Vector3d& b, double reach,
                         std::int64_t& visits, std::vector<int>& found) const {
  const Eigen::Vector3d d = b - a, grown = Eigen::Vector3d::Constant(reach);
  const auto meets = [&](const Box& box) {
    const Eigen::Vector3d low = box.min() - grown - a, high = box.max() + grown - a;
    double from = 0.0, to = 1.0;
    for (int c = 0; c < 3; ++c) {
      if (d[c] == 0.0) {
        if (low[c] > 0.0 || high[c] < 0.0) return false;
        continue;
      }
      const double at_low = low[c] / d[c], at_high = high[c] / d[c];
      from = std::max(from, std::min(at_low, at_high));
      to = std::min(to, std::max(at_low, at_high));
    }
    return from <= to;
  };
  return collect(meets, visits, found);
}

}  // namespace lightwell
