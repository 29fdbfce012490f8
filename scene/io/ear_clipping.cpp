#include <algorithm>
#include <array>
#include <set>
#include <vector>

#include "scene/io/flat_loop.h"
#include "scene/io/polygon.h"

namespace lightwell {
namespace {

bool crosses_itself_properly(const FlatLoop& p, PairTests& tests) {
  const std::size_t n = p.size();
  const LoopTree edges = tree_of_edges(p);
  for (std::size_t i = 0; i + 2 < n; ++i) {
    const LoopTree::Box about = box_of_edge(p, i);
    const std::size_t crossed = edges.find(
        i + 2, [&](const LoopTree::Box& box) { return !are_apart(about, box); },
        [&](std::size_t j) {
          tests.count();
          return cross_properly(p[i], p[i + 1], p[j], p[(j + 1) % n]);
        });
    if (crossed < n) return true;
  }
  return false;
}

bool blocks_ear(const Eigen::Vector2d& p, const Eigen::Vector2d& a, const Eigen::Vector2d& b,
                const Eigen::Vector2d& c) {
  if (p == a || p == b || p == c) return false;
  return orientation(a, b, p) >= 0.0 && orientation(b, c, p) >= 0.0 && orientation(c, a, p) >= 0.0;
}

// Cuts the ears of a loop one by one. The first ear from the second corner on is cut, so that a
// quadrilateral is cut along 0-2. A corner is tested again only where a neighbour has gone, or the
// corner that was found in the way of its ear.
class EarClipping {
 public:
  explicit EarClipping(const FlatLoop& p)
      : p_(p), tree_(tree_of_corners(p)), n_(static_cast<int>(p.size())) {
    for (int i = 0; i < n_; ++i) {
      before_.push_back((i + n_ - 1) % n_);
      after_.push_back((i + 1) % n_);
      candidates_.insert(candidates_.end(), i);
    }
    has_gone_.resize(p.size(), 0);
    waiting_.resize(p.size());
  }

  // The triangles; empty if no ear is left before the end.
  std::vector<std::array<int, 3>> triangles(PairTests& tests) {
    std::vector<std::array<int, 3>> result;
    int first = 0;  // of the corners that are left
    for (int left = n_; left >= 3; --left) {
      const int ear = next_ear(first, tests);
      if (ear < 0) return {};
      result.push_back({before(ear), ear, after(ear)});
      cut(ear);
      if (ear == first) first = after(ear);
    }
    return result;
  }

 private:
  int& before(int i) { return before_[static_cast<std::size_t>(i)]; }
  int& after(int i) { return after_[static_cast<std::size_t>(i)]; }
  const Eigen::Vector2d& at(int i) const { return p_[static_cast<std::size_t>(i)]; }

  int next_ear(int first, PairTests& tests) {
    while (!candidates_.empty()) {
      auto next = candidates_.upper_bound(first);
      if (next == candidates_.end()) next = candidates_.begin();
      if (is_ear(*next, tests)) return *next;
      candidates_.erase(next);
    }
    return -1;
  }

  bool is_ear(int i, PairTests& tests) {
    const Eigen::Vector2d &a = at(before(i)), &b = at(i), &c = at(after(i));
    tests.count();
    if (!(orientation(a, b, c) > 0.0)) return false;
    const auto in_the_way = tree_.find(
        0, [&](const LoopTree::Box& box) { return may_hold_blocks(box, a, b, c); },
        [&](std::size_t j) {
          tests.count();
          return !has_gone_[j] && blocks_ear(p_[j], a, b, c);
        });
    if (in_the_way == p_.size()) return true;
    waiting_[in_the_way].push_back(i);
    return false;
  }

  // False if a box lies outside one side of a triangle, and farther than orientation() rounds.
  static bool may_hold_blocks(const LoopTree::Box& box, const Eigen::Vector2d& a,
                              const Eigen::Vector2d& b, const Eigen::Vector2d& c) {
    const auto is_outside = [&](const Eigen::Vector2d& from, const Eigen::Vector2d& to) {
      const Eigen::Vector2d side = to - from;
      const Eigen::Vector2d inmost(side.y() > 0.0 ? box.min().x() : box.max().x(),
                                   side.x() > 0.0 ? box.max().y() : box.min().y());
      const Eigen::Vector2d at = inmost - from;
      return side.x() * at.y() - side.y() * at.x() < -2.0 * coincidence * side.norm();
    };
    return !is_outside(a, b) && !is_outside(b, c) && !is_outside(c, a);
  }

  void cut(int ear) {
    const auto e = static_cast<std::size_t>(ear);
    has_gone_[e] = 1;
    candidates_.erase(ear);
    candidates_.insert(before(ear));
    candidates_.insert(after(ear));
    for (const int corner : waiting_[e]) {
      if (!has_gone_[static_cast<std::size_t>(corner)]) candidates_.insert(corner);
    }
    after(before(ear)) = after(ear);
    before(after(ear)) = before(ear);
  }

  const FlatLoop& p_;
  LoopTree tree_;
  int n_;
  std::vector<int> before_, after_;  // neighbours among the corners that are left
  std::vector<char> has_gone_;
  std::vector<std::vector<int>> waiting_;  // by corner: those in whose way it was found
  std::set<int> candidates_;               // corners that may be ears
};

}  // namespace

std::vector<std::array<int, 3>> split_into_triangles(const Loop& loop) {
  const FlatLoop p = LoopPlane(loop).flatten(loop);
  PairTests of_edges, of_ears;
  try {
    if (crosses_itself_properly(p, of_edges)) return {};
    return EarClipping(p).triangles(of_ears);
  } catch (const TooIntricate&) {
    return {};
  }
}

}  // namespace lightwell
