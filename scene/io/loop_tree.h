#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace lightwell {

/// Work that the checks of one polygon may take, in tests of pairs: a second or two. Edges of a
/// polygon that is drawn take far less, edges that lie side by side by the ten thousand take more.
inline constexpr std::int64_t most_pair_tests = 300'000'000;

/// Boxes about runs of items in the order of a loop: neighbours in the loop are neighbours in the
/// plane, so that few items are near a given one.
class LoopTree {
 public:
  using Box = Eigen::AlignedBox2d;

  /// `box_of(i)` is the box of item i of `count`.
  template <class BoxOf>
  LoopTree(std::size_t count, BoxOf box_of) : count_(count) {
    while (leaves_ < (count + run - 1) / run) leaves_ *= 2;
    nodes_.resize(2 * leaves_);
    for (std::size_t i = 0; i < count; ++i) nodes_[leaves_ + i / run].extend(box_of(i));
    for (std::size_t n = leaves_ - 1; n > 0; --n) {
      nodes_[n] = nodes_[2 * n];
      nodes_[n].extend(nodes_[2 * n + 1]);
    }
  }

  /// The first item from `first` on for which `is_hit(item)`, of those in boxes that
  /// `may_hold(box)` lets pass; the number of items if there is none.
  template <class MayHold, class IsHit>
  std::size_t find(std::size_t first, MayHold may_hold, IsHit is_hit) const {
    return find_in(1, 0, leaves_ * run, first, may_hold, is_hit);
  }

 private:
  static constexpr std::size_t run = 8;  // items of a leaf

  template <class MayHold, class IsHit>
  std::size_t find_in(std::size_t node, std::size_t begin, std::size_t end, std::size_t first,
                      MayHold& may_hold, IsHit& is_hit) const {
    if (end <= first || begin >= count_ || !may_hold(nodes_[node])) return count_;
    if (node >= leaves_) {
      for (std::size_t i = std::max(begin, first); i < std::min(end, count_); ++i) {
        if (is_hit(i)) return i;
      }
      return count_;
    }
    const std::size_t middle = begin + (end - begin) / 2;
    const std::size_t found = find_in(2 * node, begin, middle, first, may_hold, is_hit);
    return found < count_ ? found : find_in(2 * node + 1, middle, end, first, may_hold, is_hit);
  }

  std::size_t count_, leaves_ = 1;
  std::vector<Box> nodes_{};  // the children of n are 2n and 2n + 1
};

}  // namespace lightwell
