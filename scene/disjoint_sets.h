#pragma once

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <vector>

namespace lightwell {

/// Disjoint sets of the numbers 0, 1, ... (union-find). A set is represented by its least number,
/// its root, whatever the order of joins. Paths are halved (Tarjan & van Leeuwen 1984, "Worst-case
/// analysis of set union algorithms").
class DisjointSets {
 public:
  /// Makes a set of each number below `count`.
  explicit DisjointSets(std::size_t count = 0) { add(count); }

  /// Makes `count` more sets; returns the number of the first.
  int add(std::size_t count) {
    const std::size_t first = parent_.size();
    parent_.resize(first + count);
    std::iota(parent_.begin() + static_cast<std::ptrdiff_t>(first), parent_.end(),
              static_cast<int>(first));
    return static_cast<int>(first);
  }
  std::size_t size() const { return parent_.size(); }
  /// Returns the root of the set that `i` is in.
  int root(int i) {
    auto at = static_cast<std::size_t>(i);
    while (parent_[at] != static_cast<int>(at)) {
      parent_[at] = parent_[static_cast<std::size_t>(parent_[at])];
      at = static_cast<std::size_t>(parent_[at]);
    }
    return static_cast<int>(at);
  }
  /// Joins the sets of `a` and `b`; returns the root of both.
  int join(int a, int b) {
    a = root(a), b = root(b);
    const int least = std::min(a, b);
    parent_[static_cast<std::size_t>(std::max(a, b))] = least;
    return least;
  }

 private:
  std::vector<int> parent_{};
};

}  // namespace lightwell
